"""The landmark loss and its gradient."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry.rotations.rotation_vectors import left_jacobian, rotation_matrix
from toongeo.pipeline.fit.frame.unknowns import Unknowns

__all__ = ["LandmarkLoss"]


@dataclass(frozen=True, eq=False)
class LandmarkLoss:
    """Eq. 4 of Pan et al. 2024, ``L_lan = 1/N sum_n w_n |q_n - P(R p_n + t)|^2``, with a scale in front of P.

    The weight of a point is a symmetric matrix, so that a direction can count less than another; ``w_n
    I`` gives the printed equation. A missing point weighs zero and still counts in N: what is not there
    is no evidence.

    Attributes
    ----------
    unknowns : Unknowns
        The pose is ``R = exp([w]x) R0`` with a local rotation vector w, small when R0 is near the truth, and
        the scale ``exp(l)``, which cannot become negative.
    points : (k, 2) float
        Observed points q, y up; finite.
    weights : (k, 2, 2) float
        Divide them by the square of the face size to make the loss free of units.
    count : int
        N.
    mean, modes : (k, 3) and (3 k, c) float
        The landmark vertices ``p = mean + modes a`` (Eq. 1).
    rotation0 : (3, 3) float
        R0.
    principal : (2,) float
        Where the optical axis meets the plane of the points; counts in perspective only. There a point y of the
        camera frame, with the viewer at ``1/u``, is seen at ``(y + t) / (1 - u y_z) + principal``.

    References
    ----------
    Pan et al. 2024, "Generating animatable 3D cartoon faces from single portraits", Eq. 1, 4.
    """

    unknowns: Unknowns
    points: Floats
    weights: Floats
    count: int
    mean: Floats
    modes: Floats
    rotation0: Floats
    principal: Floats = field(default_factory=lambda: np.zeros(2))

    def posed(self, x: Floats) -> Floats:
        """Landmarks (k, 3) in the camera frame, scaled but not translated: ``exp(l) R p``."""
        p = self.mean + (self.modes @ x[self.unknowns.shape]).reshape(-1, 3)
        return p @ self._rotation(x).T * np.exp(x[self.unknowns.log_scale])

    def residuals(self, x: Floats) -> Floats:
        """Errors (k, 2), projected minus observed."""
        y = self.posed(x)
        seen = y[:, :2] + x[self.unknowns.translation]
        if self.unknowns.perspective:
            seen = seen * self._growth(x, y)[:, None] + self.principal
        return seen - self.points

    def __call__(self, x: Floats) -> tuple[float, Floats]:
        """Value and gradient (n,) at ``x`` (n,)."""
        u = self.unknowns
        R = self._rotation(x)
        scale = np.exp(x[u.log_scale])
        p = self.mean + (self.modes @ x[u.shape]).reshape(-1, 3)
        y = p @ (scale * R).T
        seen = y[:, :2] + x[u.translation]
        if u.perspective:
            growth = self._growth(x, y)
            e = seen * growth[:, None] + self.principal - self.points
        else:
            e = seen - self.points
        weighted = np.einsum("kij,kj->ki", self.weights, e) / self.count

        gradient = np.empty(u.size)
        # dL/dy; without perspective the third row is zero because P drops the depth.
        pull = np.zeros(y.shape)
        pull[:, :2] = 2 * weighted
        if u.perspective:
            slope = (pull[:, :2] * seen).sum(axis=1) * growth**2
            gradient[u.inverse_distance] = slope @ y[:, 2]
            pull[:, :2] *= growth[:, None]
            pull[:, 2] = x[u.inverse_distance] * slope
        gradient[u.shape] = (pull @ (scale * R)).ravel() @ self.modes
        # dy = (J dw) x y, so dL/dw = J^T sum(y x dL/dy): the sum is the axial vector of this matrix.
        C = y.T @ pull
        torque = np.array([C[1, 2] - C[2, 1], C[2, 0] - C[0, 2], C[0, 1] - C[1, 0]])
        gradient[u.rotation] = left_jacobian(x[u.rotation]).T @ torque
        gradient[u.log_scale] = C[0, 0] + C[1, 1] + C[2, 2]
        gradient[u.translation] = np.ones(len(y)) @ pull[:, :2]
        return float(np.vdot(weighted, e)), gradient

    def jacobian(self, x: Floats) -> Floats:
        """Derivative (k, 2, n) of the residuals."""
        u = self.unknowns
        y = self.posed(x)
        lens = np.tile(np.eye(2, 3), (len(y), 1, 1))  # derivative by y
        J = np.zeros((len(y), 2, u.size))
        if u.perspective:
            growth = self._growth(x, y)
            stretch = (y[:, :2] + x[u.translation]) * growth[:, None] ** 2
            lens *= growth[:, None, None]
            lens[:, :, 2] = x[u.inverse_distance] * stretch
            J[:, :, u.inverse_distance] = stretch * y[:, 2:]
        A = np.exp(x[u.log_scale]) * self._rotation(x)
        J[:, :, u.shape] = lens @ A @ self.modes.reshape(len(y), 3, -1)
        turn = np.zeros((len(y), 3, 3))  # -[y]x
        turn[:, 0, 1], turn[:, 0, 2] = y[:, 2], -y[:, 1]
        turn[:, 1, 0], turn[:, 1, 2] = -y[:, 2], y[:, 0]
        turn[:, 2, 0], turn[:, 2, 1] = y[:, 1], -y[:, 0]
        J[:, :, u.rotation] = lens @ turn @ left_jacobian(x[u.rotation])
        J[:, :, u.log_scale] = (lens @ y[:, :, None])[:, :, 0]
        J[:, :, u.translation] = lens[:, :, :2]
        return J

    def curvature(self, x: Floats) -> Floats:
        """Diagonal (n,) of the Gauss-Newton matrix ``2/N sum_n J_n^T W_n J_n``."""
        J = self.jacobian(x)
        return 2 / self.count * ((self.weights @ J) * J).sum(axis=(0, 1))

    def matrix(self, x: Floats) -> Floats:
        """The Gauss-Newton matrix (n, n), ``2/N sum_n J_n^T W_n J_n``."""
        J = self.jacobian(x)
        return 2 / self.count * (self.weights @ J).reshape(-1, J.shape[2]).T @ J.reshape(-1, J.shape[2])

    def pose_curvature(self, x: Floats) -> Floats:
        """Rows (6, n) of the Gauss-Newton matrix that belong to rotation, scale and translation."""
        J = self.jacobian(x).reshape(2 * len(self.points), -1)
        Jp = J[:, self.unknowns.pose].reshape(-1, 2, 6)
        return 2 / self.count * (self.weights @ Jp).reshape(-1, 6).T @ J

    def _rotation(self, x: Floats) -> Floats:
        return rotation_matrix(x[self.unknowns.rotation]) @ self.rotation0

    def _growth(self, x: Floats, y: Floats) -> Floats:
        """How much larger (k,) a point is seen for being nearer than the model's origin."""
        return 1 / (1 - x[self.unknowns.inverse_distance] * y[:, 2])
