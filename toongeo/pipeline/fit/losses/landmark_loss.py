"""The landmark loss and its gradient."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry.operators.cross import cross
from toongeo.geometry.rotations.rotation_vectors import left_jacobian, rotation_matrix
from toongeo.pipeline.fit.frame.unknowns import Unknowns

__all__ = ["LandmarkLoss"]

_FLAT = np.eye(2, 3)  # P


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
        # dy = (J dw) x y, so dL/dw = J^T sum(y x dL/dy).
        C = y.T @ pull
        gradient[u.rotation] = left_jacobian(x[u.rotation]).T @ _torque(C)
        gradient[u.log_scale] = C[0, 0] + C[1, 1] + C[2, 2]
        gradient[u.translation] = np.ones(len(y)) @ pull[:, :2]
        return float(np.vdot(weighted, e)), gradient

    def normal(self, x: Floats, *, bent: bool = False) -> tuple[float, Floats, Floats]:
        """Value, gradient (n,) and the Gauss-Newton matrix (n, n), ``2/N sum_n J_n^T W_n J_n``, at ``x`` (n,).

        Bent, it is the second derivative itself, but for what is of the order of the rotation vector or lies in the
        perspective; it need not be positive definite.
        """
        near = self._linear(x)
        weighted = (self._root @ near.jacobian).reshape(-1, self.unknowns.size)
        error = (self._root @ near.errors[:, :, None]).ravel()
        unit = 2 / self.count
        matrix = unit * (weighted.T @ weighted)
        if bent and not self.unknowns.perspective:
            self._bend(matrix, near, unit * (self.weights @ near.errors[:, :, None])[:, :, 0])
        return unit / 2 * float(error @ error), unit * (error @ weighted), matrix

    def jacobian(self, x: Floats) -> Floats:
        """Derivative (k, 2, n) of the residuals."""
        return self._linear(x).jacobian

    def curvature(self, x: Floats) -> Floats:
        """Diagonal (n,) of the Gauss-Newton matrix."""
        J = self.jacobian(x)
        return 2 / self.count * ((self.weights @ J) * J).sum(axis=(0, 1))

    def pose_curvature(self, x: Floats) -> Floats:
        """Rows (6, n) of the Gauss-Newton matrix that belong to rotation, scale and translation."""
        J = self.jacobian(x).reshape(2 * len(self.points), -1)
        Jp = J[:, self.unknowns.pose].reshape(-1, 2, 6)
        return 2 / self.count * (self.weights @ Jp).reshape(-1, 6).T @ J

    def _linear(self, x: Floats) -> _Near:
        u = self.unknowns
        A = np.exp(x[u.log_scale]) * self._rotation(x)
        y = (self.mean + (self.modes @ x[u.shape]).reshape(-1, 3)) @ A.T
        turns = left_jacobian(x[u.rotation])
        seen = y[:, :2] + x[u.translation]
        J = np.zeros((len(y), 2, u.size))
        lens: Floats = _FLAT  # derivative by y
        if u.perspective:
            growth = self._growth(x, y)
            stretch = seen * growth[:, None] ** 2
            lens = growth[:, None, None] * _FLAT
            lens[:, :, 2] = x[u.inverse_distance] * stretch
            J[:, :, u.inverse_distance] = stretch * y[:, 2:]
            seen = seen * growth[:, None] + self.principal
        J[:, :, u.shape] = lens @ A @ self.modes.reshape(len(y), 3, -1)
        J[:, :, u.rotation] = lens @ _turned(y) @ turns
        J[:, :, u.log_scale] = (lens @ y[:, :, None])[:, :, 0]
        J[:, :, u.translation] = lens[..., :2]
        return _Near(seen - self.points, J, y, A, turns)

    def _bend(self, matrix: Floats, near: _Near, pull: Floats) -> None:
        """Add ``sum_n pull_n . d2y_n`` to a matrix (n, n), with the derivative (k, 2) of the loss by the points.

        A turn by d moves y by ``d x y``, twice by ``d x (d x y)``; the points are linear in the shape and in the scale.
        """
        flat = np.zeros((3, len(pull)))
        flat[:2] = pull.T
        # pull . (d x b) = (pull x d) . b for the change b of a point with the shape, and pull . b for the scale
        ways = np.empty((3, 4, len(pull)))
        ways[:, :3], ways[:, 3] = cross(flat[:, None], near.turns[:, :, None]), flat
        beside = (ways.transpose(1, 2, 0) @ near.scaled).reshape(4, -1) @ self.modes
        spread = near.points.T @ flat.T
        growth = spread.trace()
        inner = np.empty((4, 4))
        inner[:3, :3] = near.turns.T @ ((spread + spread.T) / 2 - growth * np.eye(3)) @ near.turns
        inner[3, :3] = inner[:3, 3] = _torque(spread) @ near.turns
        inner[3, 3] = growth
        turn, shape = self.unknowns.rotation, self.unknowns.shape
        pose = slice(turn.start, turn.start + 4)  # rotation and log scale
        matrix[pose, shape] += beside
        matrix[shape, pose] += beside.T
        matrix[pose, pose] += inner

    @cached_property
    def _root(self) -> Floats:
        """R (k, 2, 2) with ``R^T R = W``: Cholesky's, where a weight may be zero in a direction."""
        a, b, d = self.weights[:, 0, 0], self.weights[:, 0, 1], self.weights[:, 1, 1]
        first = np.sqrt(a)
        beside = np.divide(b, first, out=np.zeros(len(a)), where=first > 0)
        root = np.zeros(self.weights.shape)
        root[:, 0, 0], root[:, 0, 1] = first, beside
        root[:, 1, 1] = np.sqrt(np.maximum(d - beside**2, 0.0))
        return root

    def _rotation(self, x: Floats) -> Floats:
        return rotation_matrix(x[self.unknowns.rotation]) @ self.rotation0

    def _growth(self, x: Floats, y: Floats) -> Floats:
        """How much larger (k,) a point is seen for being nearer than the model's origin."""
        return 1 / (1 - x[self.unknowns.inverse_distance] * y[:, 2])


@dataclass(frozen=True, eq=False)
class _Near:
    """A loss at some unknowns: errors (k, 2), their derivative (k, 2, n), the posed points (k, 3), ``exp(l) R``, and
    the small turns (3, 3), columns, by the rotation vector."""

    errors: Floats
    jacobian: Floats
    points: Floats
    scaled: Floats
    turns: Floats


def _torque(spread: Floats) -> Floats:
    """``sum y x pull`` out of ``sum y pull^T``: its axial vector."""
    return np.array([spread[1, 2] - spread[2, 1], spread[2, 0] - spread[0, 2], spread[0, 1] - spread[1, 0]])


def _turned(y: Floats) -> Floats:
    """``-[y]x`` (k, 3, 3): how points (k, 3) move with a small turn."""
    turned = np.zeros((len(y), 3, 3))
    turned[:, 0, 1], turned[:, 0, 2] = y[:, 2], -y[:, 1]
    turned[:, 1, 0], turned[:, 1, 2] = -y[:, 2], y[:, 0]
    turned[:, 2, 0], turned[:, 2, 1] = y[:, 1], -y[:, 0]
    return turned
