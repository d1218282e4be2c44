"""A loss whose pose follows the shape, which an optimizer minimises in half the steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Floats
from toongeo.pipeline.fit.losses.total_loss import TotalLoss

__all__ = ["DecoupledPose", "decoupled_pose"]


@dataclass(frozen=True, eq=False)
class DecoupledPose:
    """The loss as a function of ``y``, where ``x`` differs from y in the pose only: ``x_p = start_p + M (y - start)``.

    A mode that widens the face can be answered by a smaller scale, one that lifts the chin by a nod: shape and pose are
    coupled, and scaling each variable by itself does not part them. Here the pose answers by itself, to first order:
    in y the rows of the Gauss-Newton matrix that belong to the pose have nothing beside the diagonal at the start.
    Shape and the viewer's distance are the same in x and y, and so are their bounds; those of the pose move along.

    Attributes
    ----------
    loss : TotalLoss
    start : (n,) float
        Where x and y are equal.
    mixing : (6, n) float
        M: how rotation, log scale and translation follow each unknown.
    curvature : (n,) float
        Diagonal of the Gauss-Newton matrix in y at the start: what the variables are scaled by.
    """

    loss: TotalLoss
    start: Floats
    mixing: Floats
    curvature: Floats

    def x(self, y: Floats) -> Floats:
        """The unknowns (n,) of the loss."""
        x, pose = y.copy(), self.loss.landmark.unknowns.pose
        x[pose] = self.start[pose] + self.mixing @ (y - self.start)
        return x

    def __call__(self, y: Floats) -> tuple[float, Floats]:
        """Value and gradient (n,) by ``y`` (n,)."""
        pose = self.loss.landmark.unknowns.pose
        value, slope = self.loss(self.x(y))
        pull = slope[pose] @ self.mixing
        slope[pose] = 0.0
        return value, slope + pull


def decoupled_pose(loss: TotalLoss, start: Floats) -> DecoupledPose:
    """The loss around a start (n,) with its pose decoupled.

    With the blocks H_pp (pose) and H_ps (pose and rest) of the Gauss-Newton matrix, the pose that minimises the
    quadratic model moves by ``-H_pp^-1 H_ps`` for each change of the rest: variable projection, to first order. The
    six themselves are parted by ``H_pp = L D L^T`` with a unit triangular L.

    References
    ----------
    G. H. Golub, V. Pereyra, "The differentiation of pseudo-inverses and nonlinear least squares problems whose
    variables separate", SIAM J. Numer. Anal. 10, 1973.
    """
    pose = loss.landmark.unknowns.pose
    curvature = loss.curvature(start)
    rows = loss.landmark_weight * loss.landmark.pose_curvature(start)
    root = np.linalg.cholesky(rows[:, pose])
    mixing = np.asarray(-np.linalg.solve(rows[:, pose], rows), np.float64)
    # What is left is positive in exact arithmetic, since the prior holds what the pose could undo.
    left = np.maximum(curvature + (rows * mixing).sum(axis=0), 1e-6 * curvature)
    mixing[:, pose] = np.linalg.inv(root / root.diagonal()).T
    left[pose] = root.diagonal() ** 2
    return DecoupledPose(loss, start, mixing, left)
