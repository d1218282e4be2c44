"""The photometric loss and its gradient."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry._cross import cross
from toongeo.pipeline.fit.photometric_samples import PhotometricSamples
from toongeo.pipeline.fit.picture_plane import PicturePlane
from toongeo.pipeline.fit.rotation import left_jacobian, rotation_matrix
from toongeo.pipeline.fit.sample_normals import SampleNormals, sample_normals
from toongeo.pipeline.fit.shading_basis import shading_basis, shading_slope
from toongeo.pipeline.fit.unknowns import Unknowns
from toongeo.render.srgb import srgb_to_linear

__all__ = ["N_LIGHT", "Observation", "PhotometricLoss"]

Floats = NDArray[np.float64]

N_LIGHT = 27  # nine harmonics in three channels
_THRESHOLD = 0.04045  # of the two branches of sRGB


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
    plane : PicturePlane
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
    plane: PicturePlane
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
        curved = 2.4 / 1.055 * ((np.maximum(srgb, _THRESHOLD) + 0.055) / 1.055) ** 1.4
        slope = np.where(srgb <= _THRESHOLD, 1 / 12.92, curved)
        basis = shading_basis(normals.units @ (self.roll @ R).T)
        return Observation(y, normals, basis, seen, seen_slope, srgb_to_linear(srgb), slope)

    def rendered(self, x: Floats, observed: Observation) -> Floats:
        """Shading times albedo (k, 3), linear light."""
        return observed.basis @ x[self.light].reshape(9, 3) * observed.reflectance

    def __call__(self, x: Floats) -> tuple[float, Floats]:
        """Value and gradient (n,) at ``x`` (n,)."""
        return self.at(x, self.observe(x))

    def at(self, x: Floats, observed: Observation) -> tuple[float, Floats]:
        """Value and gradient (n,) at ``x`` (n,), of which ``observed`` is known."""
        light = x[self.light].reshape(9, 3)
        shading = observed.basis @ light
        r = self.slopes * (shading * observed.reflectance - observed.seen)
        weighted = self.weights[:, None] * r
        pull = 2 * weighted * self.slopes  # dL/d(rendered), and minus dL/dI
        along = -(pull[:, :, None] * observed.seen_slope).sum(axis=1)
        gradient = np.empty(self.size)
        by_normal = shading_slope(
            observed.normals.units @ (self.roll @ self._rotation(x)).T, (pull * observed.reflectance) @ light.T
        )
        gradient[: self.unknowns.size] = self._of_geometry(x, observed, along, by_normal @ self.roll)
        gradient[self.albedo] = (pull * shading * observed.reflectance_slope).ravel() @ self.samples.albedo
        gradient[self.light] = (observed.basis.T @ (pull * observed.reflectance)).ravel()
        return float((weighted * r).sum()), gradient

    def _of_geometry(self, x: Floats, observed: Observation, pull: Floats, turn: Floats) -> Floats:
        """Gradient by the geometry from that by the projected points (k, 2) and by the normals (k, 3), unrolled."""
        u, y, R = self.unknowns, observed.posed, self._rotation(x)
        gradient = np.empty(u.size)
        modes = self.samples.modes
        forces = observed.normals.pulled_back(turn @ R, len(self.samples.mean))
        forces[self.samples.own] += pull @ (np.exp(x[u.log_scale]) * R[:2])
        gradient[u.shape] = forces.astype(modes.dtype).ravel() @ modes
        # dy = (J dw) x y, so dL/dw = J^T sum(y x dL/dy), where dL/dy has no third component.
        torque = np.array(
            [
                -(y[:, 2] @ pull[:, 1]),
                y[:, 2] @ pull[:, 0],
                y[:, 0] @ pull[:, 1] - y[:, 1] @ pull[:, 0],
            ]
        )
        torque += cross((observed.normals.units @ R.T).T, turn.T).sum(axis=1)
        gradient[u.rotation] = left_jacobian(x[u.rotation]).T @ torque
        gradient[u.log_scale] = (y[:, :2] * pull).sum()
        gradient[u.translation] = pull.sum(axis=0)
        return gradient

    def curvature(self, x: Floats) -> Floats:
        """Diagonal (n,) of the Gauss-Newton matrix, with the picture's slope taken as alike in all directions.

        It only scales the variables.
        """
        u = self.unknowns
        observed = self.observe(x)
        y, seen_slope = observed.posed, observed.seen_slope
        reflectance, reflectance_slope = observed.reflectance, observed.reflectance_slope
        shading = observed.basis @ x[self.light].reshape(9, 3)
        strength = 2 * self.weights[:, None] * self.slopes**2
        steep = (strength[:, :, None] * seen_slope**2).sum(axis=(1, 2)) / 2
        diagonal = np.zeros(self.size)
        modes = self.samples.modes.reshape(len(self.samples.mean), 3, -1)[self.samples.own]
        modes = modes.reshape(3 * len(y), -1)
        # Two of the three directions of a mode's step are seen.
        grown = np.repeat(2 / 3 * steep * np.exp(2 * x[u.log_scale]), 3).astype(modes.dtype)
        diagonal[u.shape] = grown @ modes**2
        x2, y2, z2 = (y**2).T
        diagonal[u.rotation] = steep @ z2, steep @ z2, steep @ (x2 + y2)
        diagonal[u.log_scale] = steep @ (x2 + y2)
        diagonal[u.translation] = steep.sum()
        diagonal[self.albedo] = (strength * (shading * reflectance_slope) ** 2).ravel() @ self.samples.albedo**2
        diagonal[self.light] = ((observed.basis**2).T @ (strength * reflectance**2)).ravel()
        return diagonal

    def _shaped(self, x: Floats) -> Floats:
        """Samples and their neighbours (r, 3) in the model frame."""
        modes = self.samples.modes
        return self.samples.mean + (modes @ x[self.unknowns.shape].astype(modes.dtype)).reshape(-1, 3)

    def _rotation(self, x: Floats) -> Floats:
        return rotation_matrix(x[self.unknowns.rotation]) @ self.rotation0
