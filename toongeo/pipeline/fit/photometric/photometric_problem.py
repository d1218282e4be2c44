"""The optimisation problem of a photometric fit, and the way to its solution.

Constants were chosen on rendered faces, seeds 20-29, and looked at on ten pictures (``benchmarks/photometric.py``).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.colour.srgb import linear_to_srgb
from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.model.morphable_model import MorphableModel
from toongeo.pipeline.fit.face_fit import FaceFit
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.photometric.gauss_newton_step import gauss_newton_step
from toongeo.pipeline.fit.photometric.light_and_albedo import ReducedLoss, best_light, light_penalty
from toongeo.pipeline.fit.photometric.photometric_loss import Observation, PhotometricLoss
from toongeo.pipeline.fit.photometric.photometric_samples import PhotometricSamples, photometric_samples
from toongeo.pipeline.fit.photometric.photometric_solution import PhotometricSolution
from toongeo.pipeline.fit.photometric.rectified_picture import RectifiedPicture, rectified_picture
from toongeo.pipeline.fit.photometric.skin_likelihood import skin_likelihood
from toongeo.pipeline.fit.photometric.visible_samples import visible_samples
from toongeo.pipeline.fit.photometric_options import PhotometricOptions
from toongeo.pipeline.fit.problem.exclusive_bounds import exclusive_bounds
from toongeo.pipeline.fit.problem.landmark_problem import LandmarkProblem
from toongeo.pipeline.fit.problem.pack_unknowns import pack_unknowns
from toongeo.pipeline.fit.problem.solution import PassState
from toongeo.pipeline.fit.problem.starting_problem import starting_problem

__all__ = ["PhotometricProblem"]

_ALGORITHM = "LD_LBFGS"
_MAX_ALBEDO = 3.0  # standard deviations
_GRAZING = 0.15  # cosine of the view below which a normal says little
_REWEIGHTINGS = 3  # of light and robust weights at the start of a pass
_MEDIAN_OF_NORM = 1.54  # of a normal variable of unit variance in three channels
_OUTLYING, _OUTLIER = 4.0, 0.05  # scale of the robust loss: standard deviations, and sRGB at least
_AMBIENT_ONLY = 1e9  # ridge that leaves no light but the ambient one
_DARKEST = 0.01  # linear light below which sRGB is taken for as steep as here
_BESIDE = 2.5  # mm from what is not believed within which a pixel may be mixed with it
_SKIN = ("cheek_left", "cheek_right", "nose")  # where skin is looked for: a fringe may cover the forehead


@dataclass(frozen=True, eq=False)
class PhotometricProblem:
    """Everything that stays the same in all passes.

    Attributes
    ----------
    model : MorphableModel
    landmarks : LandmarkProblem
        The landmark problem: unknowns, frame, bounds, landmark loss and prior.
    samples : PhotometricSamples
    plane : RectifiedPicture
    start : (n,) float
        Geometry of the landmark fit.
    prior_weight : float
        ``w_r``.
    robust_weight : (k,) float
        Robust weights of the landmarks at the start.
    options : PhotometricOptions
    """

    model: MorphableModel
    landmarks: LandmarkProblem
    samples: PhotometricSamples
    plane: RectifiedPicture
    start: Floats
    prior_weight: float
    robust_weight: Floats
    options: PhotometricOptions

    @classmethod
    def of(
        cls,
        img: NDArray[np.uint8],
        fit: FaceFit,
        pixels: Floats,
        mask: NDArray[np.float32] | None,
        options: PhotometricOptions,
        fit_options: FitOptions,
    ) -> PhotometricProblem:
        """The problem for a picture, a landmark fit, its landmarks (68, 2) px and a mask (H, W)."""
        landmarks = starting_problem(fit.model, pixels, replace(fit_options, convention=fit.report.convention))
        samples = photometric_samples(fit.model, options.samples)
        start = pack_unknowns(fit, landmarks)
        face = landmarks.frame.from_pixels(fit.project(fit.vertices[np.unique(samples.faces)]))
        plane = rectified_picture(img, mask, landmarks.frame, face, step=options.resolution, blur=options.blur)
        weight = fit.report.prior_weight
        state = PassState(fit.landmark_vertices, landmarks.target.robust_weight, weight, landmarks.search.bounds[1])
        robust_weight = landmarks.renewed(state, start, first=False).robust_weight
        problem = cls(fit.model, landmarks, samples, plane, start, weight, robust_weight, options)
        frozen = problem.frozen(problem.z0)
        if not frozen.weights.any():
            raise ValueError("mask: expected some of the face inside the picture and the mask, got nothing")
        if mask is not None:
            return replace(problem, plane=_shrunk(plane))
        skin = np.isin(frozen.samples.vertices, _skin_vertices(fit.model))
        points = frozen.posed(problem.z0)[skin, :2] + start[landmarks.unknowns.translation]
        likelihood = skin_likelihood(plane, points) * plane.confidence
        return replace(problem, plane=_shrunk(replace(plane, confidence=likelihood)))

    @property
    def z0(self) -> Floats:
        """Where the passes start: the geometry of the landmarks, the mean albedo."""
        return np.concatenate([self.start, np.zeros(self.samples.albedo.shape[1])])

    def solve(self) -> PhotometricSolution:
        """Freeze, step, and again, as often as the options say."""
        z, n, bounds = self.z0, self.landmarks.unknowns.size, self._bounds()
        first = frozen = self.frozen(z)
        penalty = self.loss(z, frozen).penalty
        observed = frozen.observe(z)
        ambient = self._rms(frozen, _lit(frozen, z, observed, _AMBIENT_ONLY * penalty), observed)
        before = self._rms(frozen, _lit(frozen, z, observed, penalty), observed)
        evaluations = 0
        for _ in range(self.options.passes):
            loss = self.loss(z, frozen)
            for _ in range(self.options.steps):
                step = gauss_newton_step(
                    loss,
                    z,
                    bounds=bounds,
                    algorithm=_ALGORITHM,
                    tolerance=self.options.tolerance,
                    max_evaluations=self.options.max_evaluations,
                )
                z, evaluations = step.z, evaluations + step.evaluations
            frozen = self.frozen(z)
        x, _ = loss.full(z)
        after = self._rms(frozen, x, frozen.observe(x))
        if after > before:  # nothing was explained: keep the face of the landmarks, in its best light
            z, frozen, loss, after = self.z0, first, self.loss(self.z0, first), before
            x = _lit(first, z, observed, penalty)
        return PhotometricSolution(
            z=z,
            light=x[loss.photometric.light].reshape(9, 3),
            landmark_vertices=self._placed(z),
            landmark_loss=loss.geometry.landmark(z[:n])[0],
            prior_loss=loss.geometry.prior_value(z[:n]),
            loss=loss(z),
            residuals=(ambient, before, after),
            confident_fraction=float(frozen.weights.sum()),
            status=step.status,
            passes=self.options.passes,
            evaluations=evaluations,
        )

    def loss(self, z: Floats, frozen: PhotometricLoss) -> ReducedLoss:
        """The loss of a pass that starts at geometry and albedo ``z``, for which `frozen` gave the samples.

        Weights and slopes depend on the light, and the light on them, so they are found in turn.
        """
        photometric, observed = frozen, frozen.observe(z)
        ridge = light_penalty(frozen, observed, self.options.light_weight)
        penalty = ridge
        for _ in range(_REWEIGHTINGS):
            rendered = photometric.rendered(_lit(photometric, z, observed, penalty), observed)
            slopes = _srgb_slope((rendered + observed.seen) / 2)
            size = np.linalg.norm(slopes * (rendered - observed.seen), axis=1)
            noise = max(_weighted_median(size, frozen.weights) / _MEDIAN_OF_NORM, self.options.noise)
            penalty = ridge * (noise / self.options.noise)
            outlying = max(_OUTLYING * noise, _OUTLIER)
            robust = 1 / (1 + (size / outlying) ** 2) ** 2  # Geman and McClure's r^2 / (1 + r^2 / s^2)
            photometric = replace(frozen, slopes=slopes, weights=frozen.weights * robust)
        photometric_weight = self._evidence(noise) * self.prior_weight
        return ReducedLoss(
            geometry=self.landmarks.loss(self._placed(z), self.prior_weight, self.robust_weight),
            photometric=photometric,
            penalty=penalty,
            photometric_weight=photometric_weight,
            albedo_weight=self.options.albedo_weight * photometric_weight,
        )

    def _evidence(self, noise: float) -> float:
        """``w_p / w_r``: independent observations over their variance.

        What the model does not explain is alike over whole regions, so a larger error also means fewer independent
        observations; their number falls as the variance rises.
        """
        return self.options.independent_samples * self.options.noise / noise**3

    def frozen(self, z: Floats) -> PhotometricLoss:
        """The photometric loss with visibility at ``z``, without robust weights."""
        u, frame, samples = self.landmarks.unknowns, self.landmarks.frame, self.samples
        V = self.model.vertices(z[u.identity], z[u.expression])
        R = frame.rotation(z[: u.size], u)
        posed = np.exp(z[u.log_scale]) * V @ R.T
        posed[:, :2] += z[u.translation]
        normals = vertex_normals(V, self.model.faces)[samples.vertices] @ R.T
        area = samples.area * np.where(normals[:, 2] > _GRAZING, normals[:, 2], 0.0) * visible_samples(posed, samples)
        at = posed[samples.vertices, :2]
        weights = area * self.plane.confidence_at(at) / max(float(area.sum()), np.finfo(float).tiny)
        rows = np.flatnonzero(weights > 0)
        return PhotometricLoss(
            unknowns=u,
            samples=samples.subset(rows),
            plane=self.plane,
            rotation0=frame.rotation0,
            roll=frame.roll,
            slopes=_srgb_slope(self.plane.sample(at[rows])[0]),
            weights=weights[rows],
        )

    def _rms(self, loss: PhotometricLoss, x: Floats, observed: Observation) -> float:
        """Root mean square difference in sRGB inside the confidence map, over samples and channels."""
        shown = linear_to_srgb(np.clip(loss.rendered(x, observed), 0.0, 1.0))
        error = ((shown - linear_to_srgb(observed.seen)) ** 2).mean(axis=1)
        return float(np.sqrt(loss.weights @ error / loss.weights.sum()))

    def _placed(self, z: Floats) -> NDArray[np.int64]:
        return self.landmarks.visible(z[: self.landmarks.unknowns.size])

    def _bounds(self) -> tuple[Floats, Floats]:
        albedo = np.full(self.samples.albedo.shape[1], _MAX_ALBEDO)
        lower, upper = self.landmarks.search.bounds
        # Counted from -1: of a pair at rest neither is let go.
        upper = exclusive_bounds(upper, 1 + self.start, self.landmarks.search.opposites)
        return np.concatenate([lower, -albedo]), np.concatenate([upper, albedo])


def _lit(loss: PhotometricLoss, z: Floats, observed: Observation, penalty: Floats) -> Floats:
    return np.concatenate([z, best_light(loss, observed, penalty).ravel()])


def _skin_vertices(model: MorphableModel) -> NDArray[np.int64]:
    names = [name for name in _SKIN if name in model.regions] or ["face"]
    return np.flatnonzero(np.any([model.region(name) for name in names], axis=0))


def _shrunk(plane: RectifiedPicture) -> RectifiedPicture:
    """Confidence that falls off before its border: the picture is smoothed, and borders are antialiased."""
    side = 2 * round(_BESIDE / plane.step) + 1
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))
    return replace(plane, confidence=np.asarray(cv2.erode(plane.confidence, kernel), np.float32))


def _srgb_slope(linear: Floats) -> Floats:
    """Derivative of `linear_to_srgb`, bounded in the dark."""
    return 1.055 / 2.4 * np.maximum(linear, _DARKEST) ** (1 / 2.4 - 1)


def _weighted_median(values: Floats, weights: Floats) -> float:
    order = np.argsort(values)
    mass = np.cumsum(weights[order])
    return float(values[order[np.searchsorted(mass, mass[-1] / 2)]])
