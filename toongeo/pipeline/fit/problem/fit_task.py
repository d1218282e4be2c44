"""One picture's fit: its problem, and what else its result says."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.arrays import Floats
from toongeo.geometry.one_thread import one_thread
from toongeo.io.check_image import check_image
from toongeo.io.check_landmarks import check_landmarks
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.adjust_coefficients import adjust_coefficients
from toongeo.pipeline.fit.face_fit import FaceFit, FitReport
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.fit.landmarks.landmark_table import landmark_table, table_landmarks
from toongeo.pipeline.fit.losses.gauss_newton import GAUSS_NEWTON
from toongeo.pipeline.fit.losses.nlopt_minimize import known_algorithms
from toongeo.pipeline.fit.problem.landmark_problem import LandmarkProblem
from toongeo.pipeline.fit.problem.solution import Solution
from toongeo.pipeline.fit.problem.starting_problem import starting_problem
from toongeo.protocols import Coefficients, Regressor

__all__ = ["FitTask", "check_call", "fit_task"]


@dataclass(frozen=True, eq=False)
class FitTask:
    """The problem of one picture.

    Attributes
    ----------
    problem : LandmarkProblem
    pixels : (k, 2) float64, px
        Its checked landmarks.
    guess : Coefficients
        A regressor's.
    warnings : tuple of sentences
    """

    problem: LandmarkProblem
    pixels: Floats
    guess: Coefficients
    warnings: tuple[str, ...]

    def face(self, solution: Solution, algorithm: str, seconds: float) -> FaceFit:
        """The fitted face of a solution, adjusted if the options ask for it."""
        problem, options = self.problem, self.problem.options
        if self.guess.pose is not None and not options.refine:
            solution = replace(solution, camera=self.guess.pose)
        rms_px, outer_eye_px = problem.error(solution, self.pixels)
        report = FitReport(
            algorithm=algorithm,
            status=solution.status,
            passes=solution.passes,
            evaluations=solution.evaluations,
            landmark_loss=solution.landmark_loss,
            prior_loss=solution.prior_loss,
            prior_weight=solution.prior_weight,
            loss=solution.loss,
            rms_px=rms_px,
            rms_percent=100 * rms_px / outer_eye_px,
            warnings=self.warnings,
            seconds=seconds,
            outliers=solution.outliers,
            convention=solution.convention,
        )
        fit = FaceFit(
            identity=solution.coefficients[problem.unknowns.identity],
            expression=solution.coefficients[problem.unknowns.expression],
            camera=solution.camera,
            landmark_vertices=solution.landmark_vertices,
            model=problem.model,
            albedo=self.guess.albedo,
            light=self.guess.light,
            report=report,
        )
        if options.adjust is None:
            return fit
        named = {} if algorithm == GAUSS_NEWTON else {"algorithm": algorithm}  # distances are no squares
        return adjust_coefficients(
            fit, self.pixels, options.adjust, max_evaluations=options.solver.max_evaluations, **named
        )


def check_call(algorithm: str, options: FitOptions, regressor: Regressor | None) -> None:
    """Refuse an unknown algorithm, and a regressor's answer without a regressor."""
    known = (GAUSS_NEWTON, *known_algorithms())
    if algorithm not in known:
        raise ValueError(f"algorithm: no algorithm {algorithm!r}; known: {', '.join(known)}")
    if regressor is None and not options.refine:
        raise ValueError("refine: expected a regressor whose answer is not to be refined, got none")


def fit_task(
    img: NDArray[np.uint8] | None,
    landmarks: ArrayLike,
    model: MorphableModel,
    options: FitOptions,
    regressor: Regressor | None,
) -> FitTask:
    """The task of a picture and its landmarks, both checked."""
    if img is not None:
        check_image(img)
    image_shape, table = None if img is None else img.shape, None
    warnings: list[str] = []
    if isinstance(options.scheme, str):
        pixels = ibug_landmarks(landmarks, options.scheme)
        warnings = check_landmarks(pixels, image_shape)
    else:
        table = landmark_table(options.scheme, model)
        pixels = table_landmarks(landmarks, table)
    guess = Coefficients() if regressor is None else regressor(img, pixels.copy())
    if not isinstance(guess, Coefficients):
        raise ValueError(f"regressor: expected one that returns Coefficients, got {type(guess).__name__}")
    with one_thread():
        problem = starting_problem(model, pixels, options, guess, table, _centre(image_shape))
    return FitTask(problem, pixels, guess, tuple(warnings))


def _centre(image_shape: tuple[int, ...] | None) -> Floats | None:
    return None if image_shape is None else np.array([image_shape[1] - 1, image_shape[0] - 1]) / 2
