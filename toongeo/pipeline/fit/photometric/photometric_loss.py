"""The photometric loss: its residuals and their derivative."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.colour.srgb import linear_slope, srgb_to_linear
from toongeo.geometry.operators.cross import cross
from toongeo.geometry.rotations.rotation_vectors import left_jacobian, rotation_matrix
from toongeo.pipeline.fit.frame.unknowns import Unknowns
from toongeo.pipeline.fit.photometric.photometric_samples import PhotometricSamples
from toongeo.pipeline.fit.photometric.rectified_picture import RectifiedPicture
from toongeo.pipeline.fit.photometric.sample_normals import SampleNormals, sample_normals
from toongeo.pipeline.fit.photometric.shading_basis import shading_basis, shading_slope

__all__ = ["N_LIGHT", "Observation", "PhotometricLoss"]

N_LIGHT = 27  # nine harmonics in three channels


@dataclass(frozen=True, eq=False)
class Observation:
    """Samples posed (k, 3) with their normals, the shading of a white one by each harmonic (k, 9), the light seen there
    (k, 3) with its slope (k, 3, 2), their reflectance (k, 3) in linear light (Eq. 2) with its slope by the sRGB value.
    """

    posed: Floats
    normals: SampleNormals
    basis: Floats
    seen: Floats
    seen_slope: Floats
    reflectance: Floats
    reflectance_slope: Floats


@dataclass(frozen=True, eq=False)
class PhotometricLoss:
    """Eq. 5 of Pan et al. 2024 over sample points: ``L_photo = 1/|A| sum_i A_i |r_i|^2``.

    ``r_i = g_i (S_i rho_i - I(P(R p_i + t)))`` per channel, all in linear light: shading S (linear in the light),
    albedo rho (linear in its coefficients in sRGB, decoded here), the picture I sampled where the point falls.
    The factor g is the slope of sRGB's transfer function near the sample, which makes r a difference in sRGB to
    first order and leaves it linear in the light. Normals follow the shape and the pose; visibility, g and the
    weights are constants of a pass.

    The vector that it takes is ``[geometry (Unknowns), albedo, light (9 x 3, row by row)]``.

    Attributes
    ----------
    unknowns : Unknowns
    samples : PhotometricSamples
    plane : RectifiedPicture
    rotation0 : (3, 3) float
        As in `LandmarkLoss`.
    roll : (3, 3) float
        From the canonical frame to the camera's, in which the light is.
    slopes : (k, 3) float
        g.
    weights : (k,) float
        Confidence times area times robust weight over ``|A|``; 0 where hidden.

    References
    ----------
    Pan et al. 2024, "Generating animatable 3D cartoon faces from single portraits", Eq. 2, 5.
    """

    unknowns: Unknowns
    samples: PhotometricSamples
    plane: RectifiedPicture
    rotation0: Floats
    roll: Floats
    slopes: Floats
    weights: Floats

    @property
    def size(self) -> int:
        """Length of the vector."""
        return self.light.stop

    @property
    def albedo(self) -> slice:
        """Where the albedo coefficients lie."""
        return slice(self.unknowns.size, self.unknowns.size + self.samples.albedo.shape[1])

    @property
    def light(self) -> slice:
        """Where the light lies."""
        return slice(self.albedo.stop, self.albedo.stop + N_LIGHT)

    def posed(self, x: Floats) -> Floats:
        """Samples (k, 3) in the camera frame, scaled but not translated."""
        return self._shaped(x)[self.samples.own] @ self._rotation(x).T * np.exp(x[self.unknowns.log_scale])

    def observe(self, x: Floats) -> Observation:
        """All that the loss needs but the light."""
        p, R = self._shaped(x), self._rotation(x)
        y = p[self.samples.own] @ R.T * np.exp(x[self.unknowns.log_scale])
        normals = sample_normals(p, self.samples)
        seen, seen_slope = self.plane.sample(y[:, :2] + x[self.unknowns.translation])
        srgb = self.samples.albedo_mean + (self.samples.albedo @ x[self.albedo]).reshape(-1, 3)
        basis = shading_basis(normals.units @ (self.roll @ R).T)
        return Observation(y, normals, basis, seen, seen_slope, srgb_to_linear(srgb), linear_slope(srgb))

    def rendered(self, x: Floats, observed: Observation) -> Floats:
        """Shading times albedo (k, 3), linear light."""
        return observed.basis @ x[self.light].reshape(9, 3) * observed.reflectance

    def residuals(self, x: Floats, observed: Observation) -> Floats:
        """``sqrt(A_i / |A|) r_i`` (k, 3), whose squares add up to the loss."""
        return np.sqrt(self.weights)[:, None] * self.slopes * (self.rendered(x, observed) - observed.seen)

    def jacobian(self, x: Floats, observed: Observation) -> NDArray[np.floating]:
        """Derivative (3 k, n) of the residuals, of the type of the modes."""
        u, y, R = self.unknowns, observed.posed, self._rotation(x)
        k, camera = len(y), self.roll @ self._rotation(x)
        light = x[self.light].reshape(9, 3)
        factor = np.sqrt(self.weights)[:, None] * self.slopes
        lit = factor * observed.reflectance
        at = observed.normals.units @ camera.T
        turn = np.stack([shading_slope(at, light[:, c]) for c in range(3)], axis=1) * lit[:, :, None] @ camera
        pull = -factor[:, :, None] * observed.seen_slope
        J = np.zeros((k, 3, self.size), self.samples.modes.dtype)
        by_vertex = observed.normals.derivative(turn, pull @ (np.exp(x[u.log_scale]) * R[:2]))
        J[:, :, u.shape] = (by_vertex @ self.samples.modes).reshape(k, 3, -1)
        # dy = (J dw) x y and dn = (J dw) x n.
        pull3 = np.pad(pull, ((0, 0), (0, 0), (0, 1)))
        torque = _cross(y, pull3) + _cross(observed.normals.units @ R.T, turn @ R.T)
        J[:, :, u.rotation] = torque @ left_jacobian(x[u.rotation])
        J[:, :, u.log_scale] = (pull * y[:, None, :2]).sum(axis=2)
        J[:, :, u.translation] = pull
        shading = factor * (observed.basis @ light) * observed.reflectance_slope
        J[:, :, self.albedo] = (shading.reshape(-1, 1) * self.samples.albedo).reshape(k, 3, -1)
        for channel in range(3):
            J[:, channel, self.light][:, channel::3] = lit[:, channel, None] * observed.basis
        return J.reshape(3 * k, -1)

    def _shaped(self, x: Floats) -> Floats:
        """Samples and their neighbours (r, 3) in the model frame."""
        modes = self.samples.modes
        return self.samples.mean + (modes @ x[self.unknowns.shape].astype(modes.dtype)).reshape(-1, 3)

    def _rotation(self, x: Floats) -> Floats:
        return rotation_matrix(x[self.unknowns.rotation]) @ self.rotation0


def _cross(points: Floats, vectors: Floats) -> Floats:
    """Each point (k, 3) times its vectors (k, c, 3)."""
    return cross(points.T[:, :, None], vectors.transpose(2, 0, 1)).transpose(1, 2, 0)
