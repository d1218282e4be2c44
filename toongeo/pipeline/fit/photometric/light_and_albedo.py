"""Light in closed form, so that it drops out of the optimisation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Floats
from toongeo.pipeline.fit.losses.total_loss import TotalLoss
from toongeo.pipeline.fit.photometric.photometric_loss import N_LIGHT, Observation, PhotometricLoss
from toongeo.pipeline.fit.photometric.quadratic_model import QuadraticModel

__all__ = ["ReducedLoss", "best_light", "light_penalty"]


def light_penalty(loss: PhotometricLoss, observed: Observation, weight: float) -> Floats:
    """Ridge (9,) on the light: nothing on its ambient part, ``weight`` times the curvature of that on the others.

    The visible half of a face hardly tells some harmonics apart. The ridge is the same in all frames, because within
    a degree it is the same for all.
    """
    strength = loss.weights[:, None] * (loss.slopes * observed.reflectance * observed.basis[:, :1]) ** 2
    penalty = np.full(9, weight * float(strength.sum()) / 3)
    penalty[0] = 0.0
    return penalty


def best_light(loss: PhotometricLoss, observed: Observation, penalty: Floats) -> Floats:
    """Light (9, 3) of least ``L_photo + sum_l penalty_l |light_l|^2`` for what is observed."""
    factor = loss.slopes * np.sqrt(loss.weights)[:, None]
    rendered, wanted = factor * observed.reflectance, factor * observed.seen
    light = np.empty((9, 3))
    for channel in range(3):
        B = observed.basis * rendered[:, channel, None]
        normal = B.T @ B
        # The floor keeps a matrix regular that few samples do not determine.
        normal[np.diag_indices(9)] += penalty + 1e-12 + 1e-9 * np.trace(normal)
        light[:, channel] = np.linalg.solve(normal, B.T @ wanted[:, channel])
    return light


@dataclass(frozen=True, eq=False)
class ReducedLoss:
    """Eq. 3 of Pan et al. 2024 with the light at its best: ``min_light w_l L_lan + w_r L_reg + w_p L_photo``.

    A function of geometry and albedo. Where the light is at its best the loss does not change with it to first
    order, so the gradient is that of the full loss at this light (variable projection).

    Attributes
    ----------
    geometry : TotalLoss
        Landmarks and prior.
    photometric : PhotometricLoss
    penalty : (9,) float
        Ridge on the light, in units of the photometric loss.
    photometric_weight, albedo_weight : float
        ``w_p``, and ``w_r w_tex`` of Eq. 6.

    References
    ----------
    G. H. Golub, V. Pereyra, "The differentiation of pseudo-inverses and nonlinear least squares problems whose
    variables separate", SIAM J. Numer. Anal. 10, 1973.
    """

    geometry: TotalLoss
    photometric: PhotometricLoss
    penalty: Floats
    photometric_weight: float
    albedo_weight: float

    def full(self, z: Floats) -> tuple[Floats, Observation]:
        """Geometry and albedo ``z`` with the light that is best for them, and what is observed there."""
        photometric = self.photometric
        x = np.concatenate([z, np.zeros(N_LIGHT)])
        observed = photometric.observe(x)
        x[photometric.light] = best_light(photometric, observed, self.penalty).ravel()
        return x, observed

    def __call__(self, z: Floats) -> float:
        """Value at ``z`` (n,)."""
        x, observed = self.full(z)
        return self._value(x, float((self.photometric.residuals(x, observed) ** 2).sum()))

    def model(self, z: Floats) -> QuadraticModel:
        """Value, gradient and Gauss-Newton matrix at ``z``, the light eliminated by its Schur complement."""
        (x, observed), n, size = self.full(z), self.photometric.unknowns.size, len(z)
        r = self.photometric.residuals(x, observed)
        J = self.photometric.jacobian(x, observed)
        normal = (J.T @ J).astype(np.float64)
        lit = normal[size:, size:] + np.diag(np.repeat(self.penalty, 3) + 1e-9 * np.trace(normal[size:, size:]))
        matrix = normal[:size, :size] - normal[:size, size:] @ np.linalg.solve(lit, normal[size:, :size])
        matrix *= 2 * self.photometric_weight
        gradient = 2 * self.photometric_weight * (r.astype(J.dtype).ravel() @ J[:, :size]).astype(np.float64)
        gradient[:n] += self.geometry(z[:n])[1]
        gradient[n:] += 2 * self.albedo_weight * z[n:]
        matrix[:n, :n] += self.geometry.normal(z[:n])[2]
        matrix[n:, n:] += 2 * self.albedo_weight * np.eye(size - n)
        return QuadraticModel(z, self._value(x, float((r**2).sum())), gradient, matrix)

    def _value(self, x: Floats, photometric: float) -> float:
        z, light = x[: self.photometric.light.start], x[self.photometric.light].reshape(9, 3)
        photometric += float(self.penalty @ (light**2).sum(axis=1))
        n = self.photometric.unknowns.size
        albedo = self.albedo_weight * float(z[n:] @ z[n:])
        return self.geometry(z[:n])[0] + self.photometric_weight * photometric + albedo
