"""The coarse stage: a morphable model fitted to the landmarks of a picture."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.one_thread import one_thread
from toongeo.io.check_image import check_image
from toongeo.io.check_landmarks import check_landmarks
from toongeo.model.default_model import default_model
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.adjust_coefficients import adjust_coefficients
from toongeo.pipeline.fit.face_fit import FaceFit, FitReport
from toongeo.pipeline.fit.fit_options import FitOptions, changed_options
from toongeo.pipeline.fit.landmarks.ibug_landmarks import ibug_landmarks
from toongeo.pipeline.fit.landmarks.landmark_table import landmark_table, table_landmarks
from toongeo.pipeline.fit.losses.nlopt_minimize import known_algorithms
from toongeo.pipeline.fit.photometric_fit import photometric_fit
from toongeo.pipeline.fit.problem.joint_fit import joint_fit
from toongeo.pipeline.fit.problem.landmark_problem import LandmarkProblem
from toongeo.pipeline.fit.problem.solution import Solution
from toongeo.pipeline.fit.problem.starting_problem import starting_problem
from toongeo.protocols import Coefficients, Regressor

__all__ = ["fit_3dmm"]


@overload
def fit_3dmm(
    img: NDArray[np.uint8] | None,
    landmarks: ArrayLike,
    *,
    model: MorphableModel | None = None,
    algorithm: str = "LD_LBFGS",
    options: FitOptions | None = None,
    regressor: Regressor | None = None,
    photometric: bool = False,
    **changes: Any,
) -> FaceFit: ...


@overload
def fit_3dmm(
    img: list[NDArray[np.uint8] | None] | list[NDArray[np.uint8]] | list[None],
    landmarks: Sequence[ArrayLike],
    *,
    model: MorphableModel | None = None,
    algorithm: str = "LD_LBFGS",
    options: FitOptions | None = None,
    regressor: Regressor | None = None,
    photometric: bool = False,
    **changes: Any,
) -> list[FaceFit]: ...


def fit_3dmm(
    img: Any,
    landmarks: Any,
    *,
    model: MorphableModel | None = None,
    algorithm: str = "LD_LBFGS",
    options: FitOptions | None = None,
    regressor: Regressor | None = None,
    photometric: bool = False,
    **changes: Any,
) -> FaceFit | list[FaceFit]:
    """Pose, identity and expression of a morphable model from landmarks.

    Minimises ``w_l L_lan + w_r L_reg`` (Eq. 3 without the photometric term): the landmark loss of Eq. 4
    and the prior of Eq. 6, about the likeliest face of the model, with a weak prior on the pitch. The camera is
    scaled orthographic, or, with ``camera="perspective"``, has a focal length that is given or found. Jaw points
    slide along the contour lines of the model: they are placed for the pose, held while the loss is minimised, and
    placed anew, until they stay.

    Errors are measured in face sizes of the picture, so its resolution, and the place and the tilt of the
    face in it, change nothing. Named expressions stay in [0, 1]. ``mouthClose`` stays 0: it corrects an
    open jaw, and 68 points do not tell a jaw dropped behind closed lips from a long chin. Of two expressions that
    exclude each other, such as ``jawLeft`` and ``jawRight``, at most one is above 0.

    Parameters
    ----------
    img : (H, W, 3) uint8 array or None, or a list of these
        The picture; without the photometric term only its size is looked at, to check the landmarks against. A list:
        pictures of one person, who has one identity in all of them, and an expression and a pose in each.
    landmarks : (68, 2) array_like, px
        iBUG-68 order, or as ``scheme`` says; x right, y down, integer = pixel centre. A NaN row is a missing point.
        With a list of pictures, a list of as many.
    model : MorphableModel, optional
        `default_model` if None.
    algorithm : str
        Any optimizer of nlopt by name; those without derivatives (``LN_``, ``GN_``) are hopeless at this
        size.
    options : FitOptions, optional
        Weights and limits.
    regressor : Regressor, optional
        ``(img, landmarks) -> Coefficients``: where the fit starts or, with ``refine=False``, the answer.
    photometric : bool
        Go on with `photometric_fit` with its defaults: shape and pose are refined, and albedo and light found, by
        comparing a rendering with the picture. Call it yourself to give it a mask.
    **changes
        Fields of `FitOptions` that differ from ``options``, as in ``fit_3dmm(img, points, robust=None)``.

    Returns
    -------
    FaceFit, or a list of as many as there are pictures

    Raises
    ------
    ValueError
        If the landmarks are not numbers, have another shape, hold infinities, are fewer than 6, coincide, lie on a
        line or outside the picture; the picture is not (H, W, 3) uint8; the algorithm is not known. If a regressor
        returns something else than coefficients, or of another shape, or there are more or fewer landmarks than
        pictures. If ``photometric`` is asked for with no picture or several, with ``adjust``, a landmark table or a
        perspective camera.
    RuntimeError
        If the optimizer fails.

    References
    ----------
    Pan et al. 2024, "Generating animatable 3D cartoon faces from single portraits", section 3.1, Eq. 1, 3, 4,
    6. Bounded L-BFGS: J. Nocedal 1980, in nlopt by S. G. Johnson after L. Lukšan.

    Examples
    --------
    >>> import numpy as np
    >>> from toongeo.model import default_model
    >>> from toongeo.render import ScaledOrthographicCamera
    >>> model = default_model()
    >>> camera = ScaledOrthographicCamera.look(yaw=20.0)
    >>> fit = fit_3dmm(None, camera.project(model.mean[model.landmarks]))
    >>> bool(abs(fit.camera.yaw - 20.0) < 2.0)
    True
    """
    started = time.perf_counter()
    options = changed_options(options, changes)
    model = default_model() if model is None else model
    if algorithm not in known_algorithms():
        raise ValueError(f"algorithm: no algorithm {algorithm!r}; known: {', '.join(known_algorithms())}")
    if regressor is None and not options.refine:
        raise ValueError("refine: expected a regressor whose answer is not to be refined, got none")
    together = isinstance(img, list)
    pictures = _pairs(img, landmarks) if together else [(img, landmarks)]
    if photometric:
        _check_photometric(img, options)
    tasks = [_task(*picture, model, options, regressor) for picture in pictures]
    with one_thread():
        if together:
            solutions = joint_fit([task.problem for task in tasks], algorithm)
        else:
            solutions = [tasks[0].problem.solve(algorithm)]
        seconds = time.perf_counter() - started
        fits = [_face(task, solution, algorithm, seconds) for task, solution in zip(tasks, solutions, strict=True)]
        if options.adjust is not None:
            fits = [
                adjust_coefficients(
                    fit, task.pixels, options.adjust, algorithm=algorithm, max_evaluations=options.max_evaluations
                )
                for fit, task in zip(fits, tasks, strict=True)
            ]
    if photometric:
        return photometric_fit(img, fits[0], tasks[0].pixels, fit_options=options)
    return fits if together else fits[0]


def _check_photometric(img: Any, options: FitOptions) -> None:
    """A picture alone can be rendered and compared; what it would undo is refused."""
    if img is None or isinstance(img, list):
        got = "None" if img is None else f"{len(img)} pictures, whose shared identity each would change"
        raise ValueError(f"img: expected one picture for the photometric term, got {got}")
    if not isinstance(options.scheme, str):
        raise ValueError("scheme: expected a scheme by name with the photometric term, got a table")
    if options.adjust is not None:
        raise ValueError(f"adjust: expected None with the photometric term, which has a prior, got {options.adjust!r}")


@dataclass(frozen=True, eq=False)
class _Task:
    """One picture's problem, and what else its result says."""

    model: MorphableModel
    problem: LandmarkProblem
    pixels: NDArray[np.float64]
    guess: Coefficients
    warnings: list[str]


def _pairs(imgs: list[Any], landmarks: Any) -> list[tuple[Any, Any]]:
    if len(imgs) == 0 or len(landmarks) != len(imgs):
        raise ValueError(f"landmarks: expected one set for each of {len(imgs)} pictures, got {len(landmarks)}")
    return list(zip(imgs, landmarks, strict=True))


def _task(
    img: NDArray[np.uint8] | None,
    landmarks: ArrayLike,
    model: MorphableModel,
    options: FitOptions,
    regressor: Regressor | None,
) -> _Task:
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
    return _Task(model, problem, pixels, guess, warnings)


def _face(task: _Task, solution: Solution, algorithm: str, seconds: float) -> FaceFit:
    if task.guess.pose is not None and not task.problem.options.refine:
        solution = replace(solution, camera=task.guess.pose)
    rms_px, outer_eye_px = task.problem.error(solution, task.pixels)
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
        warnings=tuple(task.warnings),
        seconds=seconds,
        outliers=solution.outliers,
    )
    return FaceFit(
        identity=solution.coefficients[task.problem.unknowns.identity],
        expression=solution.coefficients[task.problem.unknowns.expression],
        camera=solution.camera,
        landmark_vertices=solution.landmark_vertices,
        model=task.model,
        albedo=task.guess.albedo,
        light=task.guess.light,
        report=report,
    )


def _centre(image_shape: tuple[int, ...] | None) -> NDArray[np.float64] | None:
    return None if image_shape is None else np.array([image_shape[1] - 1, image_shape[0] - 1]) / 2
