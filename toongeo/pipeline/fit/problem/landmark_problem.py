"""The optimisation problem of a landmark fit, and the way to its solution.

Constants were chosen on heads of known shape and ten pictures (``benchmarks/truth3d.py``, ``benchmarks/landmarks.py``).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

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
from toongeo.pipeline.fit.losses.landmark_loss import LandmarkLoss
from toongeo.pipeline.fit.losses.minimized import minimized
from toongeo.pipeline.fit.losses.pitch_prior import PitchPrior
from toongeo.pipeline.fit.losses.prior_loss import PriorLoss
from toongeo.pipeline.fit.losses.total_loss import TotalLoss
from toongeo.pipeline.fit.problem.exclusive_bounds import exclusive_bounds
from toongeo.pipeline.fit.problem.landmark_target import LandmarkTarget, SearchBox
from toongeo.pipeline.fit.problem.landmark_weights import evened_weights
from toongeo.pipeline.fit.problem.solution import PassState, Solution
from toongeo.pipeline.fit.problem.told_convention import scans_tell

__all__ = ["LandmarkProblem"]

_PITCH_WEIGHT = 4e-6  # of the prior on the pitch, which grows as w_r does
_GROWTH = 4.0  # a loose first pass bends the face to most of what is odd: the misfit it leaves is a small part
_ROUGH = 2.0  # times the expected misfit: what a single landmark may miss by without being odd at all
_IGNORED = 0.1  # a point with less robust weight is called an outlier


@dataclass(frozen=True, eq=False)
class LandmarkProblem:
    """Everything that stays the same while the jaw points are placed anew; `starting_problem` makes it.

    Attributes
    ----------
    model : MorphableModel
    unknowns : Unknowns
    basis : LandmarkBasis
    frame : CanonicalFrame
    principal_point : (2,) float, px
        Counts in perspective only.
    target : LandmarkTarget
    search : SearchBox
    prior : PriorLoss
    options : FitOptions
    """

    model: MorphableModel
    unknowns: Unknowns
    basis: LandmarkBasis
    frame: CanonicalFrame
    principal_point: Floats
    target: LandmarkTarget
    search: SearchBox
    prior: PriorLoss
    options: FitOptions

    def solve(self, algorithm: str) -> Solution:
        """Minimise, place the jaw points anew, and again, until they stay or ``max_passes`` are done.

        Annotators differ, and the landmarks of a face in the model are met to about that accuracy. One that the first
        pass misses by more is outside the model: its surplus misfit is a variance of the landmarks too, and the prior
        then counts the more.
        A few points that lie far off beside the others are no face outside the model: they lose their weight, in
        the misfit and in the next pass.
        """
        problem, x, state = self, self.search.start, self.first_state(self.search.start)
        passes = evaluations = 0
        while passes < self.options.solver.max_passes:
            loss = problem.loss(state.vertices, state.prior_weight, state.robust_weight)
            minimum = minimized(loss, x, (self.search.bounds[0], state.upper), algorithm, self.options.solver)
            x = minimum.x
            passes, evaluations = passes + 1, evaluations + minimum.evaluations
            asked, (problem, x) = problem, problem.told(state, x)
            before, state = state, problem.renewed(state, x, first=passes == 1)
            if asked.target.convention == problem.target.convention and problem.settled(before, state):
                break
        return problem.solution(x, before, state, minimum.status, passes, evaluations)

    def first_state(self, x: Floats) -> PassState:
        """What the first pass holds fixed."""
        return PassState(self.visible(x), self.target.robust_weight, self.options.prior_weight, self.search.bounds[1])

    def told(self, state: PassState, x: Floats) -> tuple[LandmarkProblem, Floats]:
        """This problem, or the same with the landmarks of scans where the first pass, which ended at ``x``, tells so.

        With it comes where the next pass begins.

        It is asked once. The points of a mesh of scans are nearly all off in the same way from where annotators click,
        and no face explains that.
        """
        target = self.target
        if target.scan_offsets is None:
            return self, x
        other = replace(self, target=replace(target, offsets=target.scan_offsets, convention="scans"))
        before, after = (p.loss(state.vertices, state.prior_weight, state.robust_weight) for p in (self, other))
        there = scans_tell(before, after, x, (self.search.bounds[0], state.upper))
        told, x = (self, x) if there is None else (other, there)
        return replace(told, target=replace(told.target, scan_offsets=None)), x

    def renewed(self, state: PassState, x: Floats, *, first: bool) -> PassState:
        """What the next pass holds fixed after one that ended at ``x``; the first one tells the prior's weight."""
        errors = self.loss(state.vertices, self.options.prior_weight).landmark.residuals(x)  # whatever the weights
        robust_weight = self._robust_weight(errors)
        prior_weight = state.prior_weight
        if first:
            squares = robust_weight * np.einsum("ki,kij,kj->k", errors, self.target.weights, errors)
            misfit = float(squares.sum()) / self.target.count
            expected = 2 * self.options.prior.landmark_deviation**2
            prior_weight *= 1 + _GROWTH * max(0.0, misfit / expected - 1)
        upper = exclusive_bounds(state.upper, x, self.search.opposites)
        return PassState(self.visible(x), robust_weight, prior_weight, upper)

    def settled(self, before: PassState, after: PassState) -> bool:
        """Whether another pass would find the same."""
        stayed = self.target.own is not None or np.array_equal(before.vertices, after.vertices)
        believed = np.abs(after.robust_weight - before.robust_weight).max() <= SETTLED
        same = before.prior_weight == after.prior_weight and np.array_equal(before.upper, after.upper)
        return bool(stayed and believed and same)

    def solution(
        self, x: Floats, state: PassState, after: PassState, status: str, passes: int, evaluations: int
    ) -> Solution:
        """The face where a pass that began with one state ended at ``x``, from which another would go on."""
        held = np.minimum(x, after.upper)
        vertices = after.vertices if np.array_equal(x, held) else self.visible(held)
        loss = self.loss(state.vertices, state.prior_weight, state.robust_weight)
        x = held
        landmark, prior = loss.landmark(x)[0], loss.prior_value(x)
        return Solution(
            coefficients=x[self.unknowns.shape],
            camera=self.frame.camera(x, self.unknowns, self.principal_point),
            landmark_vertices=vertices,
            landmark_loss=landmark,
            prior_loss=prior,
            prior_weight=loss.prior_weight,
            loss=loss.landmark_weight * landmark + loss.prior_weight * prior,
            status=status,
            passes=passes,
            evaluations=evaluations,
            convention=self.target.convention,
            outliers=tuple(int(k) for k in self.target.seen[state.robust_weight < _IGNORED]),
        )

    def error(self, solution: Solution, pixels: Floats) -> tuple[float, float]:
        """Root mean square error of the inner landmarks, or of all in a table, and the outer-eye distance, px."""
        mean, modes = self.basis.at(solution.landmark_vertices)
        fitted = solution.camera.project(mean + (modes @ solution.coefficients).reshape(-1, 3))
        if self.target.own is None:
            return inner_error(fitted, pixels)
        own = solution.camera.project(self.target.own[0] + (self.target.own[1] @ solution.coefficients).reshape(-1, 3))
        right, left = fitted[list(OUTER_EYES)]
        rms = np.sqrt(((own - pixels[self.target.seen]) ** 2).sum(axis=1).mean())
        return float(rms), float(np.linalg.norm(left - right))

    def loss(
        self, landmark_vertices: NDArray[np.int64], prior_weight: float, robust_weight: Floats | None = None
    ) -> TotalLoss:
        """Eq. 3 with the landmarks (68,) at these vertices, this ``w_r``, and robust weights (k,)."""
        mean, modes = self.basis.at(landmark_vertices[self.target.seen]) if self.target.own is None else self.target.own
        if self.target.own is None:
            mean = mean + self.target.offsets[self.target.seen]
        weights = evened_weights(
            self.target.weights, prior_weight / self.options.prior_weight - 1, self.basis.outer_eye_mm
        )
        landmark = LandmarkLoss(
            unknowns=self.unknowns,
            points=self.target.points,
            weights=weights if robust_weight is None else robust_weight[:, None, None] * weights,
            count=self.target.count,
            mean=mean,
            modes=modes,
            rotation0=self.frame.rotation0,
            principal=self.frame.from_pixels(self.principal_point),
        )
        nod = PitchPrior(self.unknowns, self.frame.rotation0, self.options.prior.pitch_deviation)
        pitch_weight = prior_weight / self.options.prior_weight * _PITCH_WEIGHT
        return TotalLoss(landmark, self.prior, nod, self.options.landmark_weight, prior_weight, pitch_weight)

    def _robust_weight(self, residuals: Floats) -> Floats:
        """Robust weights (k,) for errors (k, 2), mm; along an outline an error counts less here too."""
        W = self.target.weights  # its larger eigenvalue is the weight across an outline, or in all directions
        half = (W[:, 0, 0] - W[:, 1, 1]) / 2
        importance = (W[:, 0, 0] + W[:, 1, 1]) / 2 + np.sqrt(half**2 + W[:, 0, 1] ** 2)
        importance *= self.basis.outer_eye_mm**2
        reasons = outlier_errors(residuals, self.target.neighbours)
        costs = np.einsum("cki,kij,ckj->ck", reasons, self.target.weights, reasons).min(axis=0)
        squares = np.divide(costs, importance, out=np.full(len(costs), np.nan), where=importance > 0)
        return robust_weights(squares, self.options.robust, (_ROUGH * self.options.prior.landmark_deviation) ** 2)

    def visible(self, x: Floats) -> NDArray[np.int64]:
        """The 68 landmark vertices of the face at ``x``: jaw points on their lines, or on the silhouette."""
        coefficients = x[self.unknowns.shape]
        landmarks = visible_landmarks(self.basis, coefficients, self.frame.rotation(x, self.unknowns))
        if self.options.contour == "lines" or self.target.own is not None:
            return landmarks
        camera = self.frame.camera(x, self.unknowns, self.principal_point)
        return silhouette_landmarks(self.model, coefficients, camera, self.target.pixels, landmarks)
