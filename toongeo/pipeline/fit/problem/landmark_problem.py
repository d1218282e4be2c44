"""The optimisation problem of a landmark fit, and the way to its solution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.model.anatomy.landmark_basis import LandmarkBasis
from toongeo.model.anatomy.visible_landmarks import visible_landmarks
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.frame.canonical_frame import CanonicalFrame
from toongeo.pipeline.fit.frame.unknowns import Unknowns
from toongeo.pipeline.fit.landmarks.inner_error import inner_error
from toongeo.pipeline.fit.landmarks.outlier_errors import outlier_errors
from toongeo.pipeline.fit.landmarks.robust_weights import SETTLED, robust_weights
from toongeo.pipeline.fit.landmarks.silhouette import silhouette_landmarks
from toongeo.pipeline.fit.losses.decoupled_pose import decoupled_pose
from toongeo.pipeline.fit.losses.landmark_loss import LandmarkLoss
from toongeo.pipeline.fit.losses.nlopt_minimize import nlopt_minimize
from toongeo.pipeline.fit.losses.pitch_prior import PitchPrior
from toongeo.pipeline.fit.losses.prior_loss import PriorLoss
from toongeo.pipeline.fit.losses.total_loss import TotalLoss
from toongeo.pipeline.fit.problem.exclusive_bounds import exclusive_bounds
from toongeo.pipeline.fit.problem.landmark_weights import evened_weights
from toongeo.pipeline.fit.problem.solution import PassState, Solution

__all__ = ["LandmarkProblem"]

_PITCH_WEIGHT = 4e-6  # of the prior on the pitch, which grows as w_r does
_GROWTH = 4.0  # a loose first pass bends the face to most of what is odd: the misfit it leaves is a small part
_ROUGH = 2.0  # times the expected misfit: what a single landmark may miss by without being odd at all
_DISTRUST = 0.1  # a point with less robust weight is called an outlier


@dataclass(frozen=True, eq=False)
class LandmarkProblem:
    """Everything that stays the same while the jaw points are placed anew; `starting_problem` makes it.

    Attributes
    ----------
    model : MorphableModel
    pixels : (68, 2) or (k, 2) float, px
        As they came, NaN rows missing.
    unknowns : Unknowns
    basis : LandmarkBasis
    frame : CanonicalFrame
    seen : (k,) int
        Landmarks that are there.
    points : (k, 2) float
        These in the canonical frame, mm.
    weights : (k, 2, 2) float, 1/mm^2
        Their weights in Eq. 4, with errors in outer-eye distances.
    offsets : (68, 3) float, mm, model frame
        From the landmarks of the model to where annotators see them.
    prior : PriorLoss
    bounds : two (n,) arrays
    options : FitOptions
    own : mean (k, 3) and modes (3 k, c), or None
        Landmarks of the caller's own table, which do not slide.
    count : int
        N of Eq. 4: a point that is missing counts.
    principal_point : (2,) float, px
        Counts in perspective only.
    neighbours : (k, k) bool
    opposites : (p, 2) int
        Unknowns of which at most one is above zero.
    start : (n,) float
    trust : (k,) float
        Robust weights with which the first pass begins.
    """

    model: MorphableModel
    pixels: Floats
    unknowns: Unknowns
    basis: LandmarkBasis
    frame: CanonicalFrame
    seen: NDArray[np.int64]
    points: Floats
    weights: Floats
    offsets: Floats
    prior: PriorLoss
    bounds: tuple[Floats, Floats]
    options: FitOptions
    own: tuple[Floats, Floats] | None
    count: int
    principal_point: Floats
    neighbours: NDArray[np.bool_]
    opposites: NDArray[np.int64]
    start: Floats
    trust: Floats

    def solve(self, algorithm: str) -> Solution:
        """Minimise, place the jaw points anew, and again, until they stay or ``max_passes`` are done.

        Annotators differ, and the landmarks of a face in the model are met to about that accuracy. One that the first
        pass misses by more is outside the model: its surplus misfit is a variance of the landmarks too, and the prior
        then counts the more.
        A few points that lie far off beside the others are no face outside the model: they lose their weight, in
        the misfit and in the next pass.
        """
        x, placement = self.start, self.placement(self.start)
        passes = evaluations = 0
        while passes < self.options.max_passes:
            loss = self.loss(placement.vertices, placement.prior_weight, placement.trust)
            decoupled = decoupled_pose(loss, x)
            minimum = nlopt_minimize(
                decoupled,
                x,
                bounds=(self.bounds[0], placement.upper),
                scale=1 / np.sqrt(decoupled.curvature),
                algorithm=algorithm,
                tolerance=self.options.tolerance,
                max_evaluations=self.options.max_evaluations,
                max_seconds=self.options.max_seconds,
            )
            x = decoupled.x(minimum.x)
            passes, evaluations = passes + 1, evaluations + minimum.evaluations
            before, placement = placement, self.renewed(placement, x, first=passes == 1)
            if self.settled(before, placement):
                break
        return self.solution(np.minimum(x, placement.upper), before, minimum.status, passes, evaluations)

    def placement(self, x: Floats) -> PassState:
        """What the first pass holds fixed."""
        return PassState(self.visible(x), self.trust, self.options.prior_weight, self.bounds[1])

    def renewed(self, placement: PassState, x: Floats, *, first: bool) -> PassState:
        """What the next pass holds fixed after one that ended at ``x``; the first one tells the prior's weight."""
        loss = self.loss(placement.vertices, placement.prior_weight)
        errors = loss.landmark.residuals(x)
        trust = self._trusted(errors)
        prior_weight = placement.prior_weight
        if first:
            misfit = float((trust * np.einsum("ki,kij,kj->k", errors, self.weights, errors)).sum()) / self.count
            expected = 2 * self.options.landmark_deviation**2
            prior_weight *= 1 + _GROWTH * max(0.0, misfit / expected - 1)
        upper = exclusive_bounds(placement.upper, x, self.opposites)
        return PassState(self.visible(x), trust, prior_weight, upper)

    def settled(self, before: PassState, after: PassState) -> bool:
        """Whether another pass would find the same."""
        stayed = self.own is not None or np.array_equal(before.vertices, after.vertices)
        believed = np.abs(after.trust - before.trust).max() <= SETTLED
        same = before.prior_weight == after.prior_weight and np.array_equal(before.upper, after.upper)
        return bool(stayed and believed and same)

    def solution(self, x: Floats, placement: PassState, status: str, passes: int, evaluations: int) -> Solution:
        """The face at ``x``, where a pass with this placement ended."""
        loss = self.loss(placement.vertices, placement.prior_weight, placement.trust)
        return Solution(
            coefficients=x[self.unknowns.shape],
            camera=self.frame.camera(x, self.unknowns, self.principal_point),
            landmark_vertices=self.visible(x),
            landmark_loss=loss.landmark(x)[0],
            prior_loss=loss.prior_value(x),
            prior_weight=loss.prior_weight,
            loss=loss(x)[0],
            status=status,
            passes=passes,
            evaluations=evaluations,
            outliers=tuple(int(k) for k in self.seen[placement.trust < _DISTRUST]),
        )

    def error(self, solution: Solution, pixels: Floats) -> tuple[float, float]:
        """Root mean square error of the inner landmarks, or of all in a table, and the outer-eye distance, px."""
        mean, modes = self.basis.at(solution.landmark_vertices)
        fitted = solution.camera.project(mean + (modes @ solution.coefficients).reshape(-1, 3))
        if self.own is None:
            return inner_error(fitted, pixels)
        own = solution.camera.project(self.own[0] + (self.own[1] @ solution.coefficients).reshape(-1, 3))
        right, left = fitted[list(OUTER_EYES)]
        rms = np.sqrt(((own - pixels[self.seen]) ** 2).sum(axis=1).mean())
        return float(rms), float(np.linalg.norm(left - right))

    def loss(self, landmark_vertices: NDArray[np.int64], prior_weight: float, trust: Floats | None = None) -> TotalLoss:
        """Eq. 3 with the landmarks (68,) at these vertices, this ``w_r``, and robust weights (k,)."""
        mean, modes = self.basis.at(landmark_vertices[self.seen]) if self.own is None else self.own
        if self.own is None:
            mean = mean + self.offsets[self.seen]
        weights = evened_weights(self.weights, prior_weight / self.options.prior_weight - 1, self.basis.outer_eye_mm)
        landmark = LandmarkLoss(
            unknowns=self.unknowns,
            points=self.points,
            weights=weights if trust is None else trust[:, None, None] * weights,
            count=self.count,
            mean=mean,
            modes=modes,
            rotation0=self.frame.rotation0,
            principal=self.frame.from_pixels(self.principal_point),
        )
        nod = PitchPrior(self.unknowns, self.frame.rotation0, self.options.pitch_deviation)
        pitch_weight = prior_weight / self.options.prior_weight * _PITCH_WEIGHT
        return TotalLoss(landmark, self.prior, nod, self.options.landmark_weight, prior_weight, pitch_weight)

    def _trusted(self, residuals: Floats) -> Floats:
        """Robust weights (k,) for errors (k, 2), mm; along an outline an error counts less here too."""
        W = self.weights  # its larger eigenvalue is the weight across an outline, or in all directions
        half = (W[:, 0, 0] - W[:, 1, 1]) / 2
        importance = (W[:, 0, 0] + W[:, 1, 1]) / 2 + np.sqrt(half**2 + W[:, 0, 1] ** 2)
        importance *= self.basis.outer_eye_mm**2
        reasons = outlier_errors(residuals, self.neighbours)
        costs = np.einsum("cki,kij,ckj->ck", reasons, self.weights, reasons).min(axis=0)
        squares = np.divide(costs, importance, out=np.full(len(costs), np.nan), where=importance > 0)
        return robust_weights(squares, self.options.robust, (_ROUGH * self.options.landmark_deviation) ** 2)

    def visible(self, x: Floats) -> NDArray[np.int64]:
        """The 68 landmark vertices of the face at ``x``: jaw points on their lines, or on the silhouette."""
        coefficients = x[self.unknowns.shape]
        landmarks = visible_landmarks(self.basis, coefficients, self.frame.rotation(x, self.unknowns))
        if self.options.contour == "lines" or self.own is not None:
            return landmarks
        camera = self.frame.camera(x, self.unknowns, self.principal_point)
        return silhouette_landmarks(self.model, coefficients, camera, self.pixels, landmarks)
