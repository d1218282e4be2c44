"""The landmark loss and its gradient."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.fit.rotation import left_jacobian, rotation_matrix
from toongeo.pipeline.fit.unknowns import Unknowns

__all__ = ["LandmarkLoss"]

Floats = NDArray[np.float64]


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

    def posed(self, x: Floats) -> Floats:
        """Landmarks (k, 3) in the camera frame, scaled but not translated: ``exp(l) R p``."""
        p = self.mean + (self.modes @ x[self.unknowns.shape]).reshape(-1, 3)
        return p @ self._rotation(x).T * np.exp(x[self.unknowns.log_scale])

    def residuals(self, x: Floats) -> Floats:
        """Errors (k, 2), projected minus observed."""
        return self.posed(x)[:, :2] + x[self.unknowns.translation] - self.points

    def __call__(self, x: Floats) -> tuple[float, Floats]:
        """Value and gradient (n,) at ``x`` (n,)."""
        u = self.unknowns
        R = self._rotation(x)
        scale = np.exp(x[u.log_scale])
        p = self.mean + (self.modes @ x[u.shape]).reshape(-1, 3)
        y = p @ (scale * R).T
        e = y[:, :2] + x[u.translation] - self.points
        weighted = (self.weights @ e[:, :, None])[:, :, 0] / self.count

        # dL/dy; the third row is zero because P drops the depth.
        pull = np.zeros_like(y)
        pull[:, :2] = 2 * weighted
        gradient = np.empty(u.size)
        gradient[u.shape] = (pull @ (scale * R)).ravel() @ self.modes
        # dy = (J dw) x y, so dL/dw = J^T sum(y x dL/dy): the sum is the axial vector of this matrix.
        C = y.T @ pull
        torque = np.array([C[1, 2] - C[2, 1], C[2, 0] - C[0, 2], C[0, 1] - C[1, 0]])
        gradient[u.rotation] = left_jacobian(x[u.rotation]).T @ torque
        gradient[u.log_scale] = C[0, 0] + C[1, 1]
        gradient[u.translation] = pull[:, :2].sum(axis=0)
        return float((weighted * e).sum()), gradient

    def jacobian(self, x: Floats) -> Floats:
        """Derivative (k, 2, n) of the residuals."""
        u = self.unknowns
        y = self.posed(x)
        A = np.exp(x[u.log_scale]) * self._rotation(x)[:2]
        J = np.zeros((len(y), 2, u.size))
        J[:, :, u.shape] = A @ self.modes.reshape(len(y), 3, -1)
        turn = np.zeros((len(y), 2, 3))  # rows of -[y]x
        turn[:, 0, 1], turn[:, 0, 2] = y[:, 2], -y[:, 1]
        turn[:, 1, 0], turn[:, 1, 2] = -y[:, 2], y[:, 0]
        J[:, :, u.rotation] = turn @ left_jacobian(x[u.rotation])
        J[:, :, u.log_scale] = y[:, :2]
        J[:, :, u.translation] = np.eye(2)
        return J

    def curvature(self, x: Floats) -> Floats:
        """Diagonal (n,) of the Gauss-Newton matrix ``2/N sum_n J_n^T W_n J_n``."""
        J = self.jacobian(x)
        return 2 / self.count * ((self.weights @ J) * J).sum(axis=(0, 1))

    def _rotation(self, x: Floats) -> Floats:
        return rotation_matrix(x[self.unknowns.rotation]) @ self.rotation0
