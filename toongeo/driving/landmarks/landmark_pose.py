"""Pose and expression of a known face from one frame of landmarks.

Constants were judged on the heads of the seven examples (``benchmarks/driving.py``).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Floats
from toongeo.driving.landmark_rig import LandmarkRig
from toongeo.geometry.operators.bounded_quadratic import bounded_quadratic
from toongeo.geometry.rotations.rotation_vectors import rotation_matrix
from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose

__all__ = ["FEWEST", "LandmarkPose", "landmark_pose", "landmark_poses"]

FEWEST = 12  # landmarks that a frame must have
_SPREAD = 1.0  # s.d. of a weight before anything is seen
_SPARSITY = 1.0  # how much a weight of 1 costs beside: few expressions explain a face better than many
_OUTLIER = 0.01  # of the face's width: an error that counts a quarter
_POSE = 6  # rotation vector, log scale, translation
_FLIP = np.array([1.0, -1.0])
_STEPS = 12  # of Gauss-Newton at most
_SETTLED = 1e-4  # change of a weight in a step; what is smaller is not seen
_PLAIN_STEPS = 2  # before errors are told from expressions


@dataclass(frozen=True, eq=False)
class LandmarkPose:
    """How a face is held and what it expresses.

    Attributes
    ----------
    weights : (k,) float64 in [0, 1]
    scale : float, px/mm
    rotation : (3, 3), model to camera frame
    translation : (2,), px
    """

    weights: Floats
    scale: float
    rotation: Floats
    translation: Floats

    def head_frame(self, pixels: Floats, rig: LandmarkRig) -> Floats:
        """How far landmarks (68, 2) px are from those of the neutral face in this pose: (68, 2), mm, y up."""
        return (pixels - self.translation) * _FLIP / self.scale - (rig.neutral @ self.rotation.T)[:, :2]

    def picture(self, moved: Floats, rig: LandmarkRig) -> Floats:
        """Inverse of :meth:`head_frame`."""
        flat = (rig.neutral @ self.rotation.T)[:, :2] + moved
        return self.scale * flat * _FLIP + self.translation

    def errors(self, pixels: Floats, rig: LandmarkRig) -> Floats:
        """What the face leaves unexplained of landmarks (68, 2) px, in its widths."""
        posed = (np.tensordot(self.weights, rig.deltas, 1) @ self.rotation.T)[:, :2]
        return (self.head_frame(pixels, rig) - posed) / rig.width


def landmark_pose(rig: LandmarkRig, pixels: Floats, weights: Floats, noise: float) -> LandmarkPose:
    """The scaled orthographic pose and the weights in [0, 1] that explain landmarks best.

    Gauss-Newton on ``|errors|^2 / noise^2 + |w|^2 / _SPREAD^2 + 2 _SPARSITY sum w`` over weights and pose together,
    each step a quadratic problem with bounds. Errors that no expression explains lose influence (Geman and McClure).

    Parameters
    ----------
    rig : LandmarkRig
    pixels : (68, 2) px
        At least FEWEST rows; NaN rows are missing.
    weights : (k,)
        Where to start.
    noise : float > 0
        Standard deviation of a coordinate, in widths of the face.

    Raises
    ------
    ValueError
        If the landmarks lie on a line.
    """
    there = np.asarray(np.isfinite(pixels).all(axis=1))
    shape = rig.neutral + np.tensordot(weights, rig.deltas, 1)
    pose = LandmarkPose(weights, *scaled_orthographic_pose(shape[there], pixels[there]))
    for step in range(_STEPS):
        robust_weight = there.astype(np.float64)
        if step >= _PLAIN_STEPS:
            square = (np.nan_to_num(pose.errors(pixels, rig)) ** 2).sum(axis=1)
            robust_weight = there / (1 + square / max(_OUTLIER, 3 * noise) ** 2) ** 2
        after = _step(rig, pixels, pose, robust_weight, noise)
        change = np.abs(after.weights - pose.weights).max()
        pose = after
        if change < _SETTLED and step >= _PLAIN_STEPS:
            break
    return pose


def landmark_poses(rig: LandmarkRig, sequence: Floats, noise: float) -> list[LandmarkPose]:
    """Of every frame of (f, 68, 2) px by itself; of one with too few landmarks, that of the frame before it.

    Raises
    ------
    ValueError
        If no frame has enough landmarks, or those of one lie on a line.
    """
    seen = np.isfinite(sequence).all(axis=2).sum(axis=1) >= FEWEST
    if not seen.any():
        raise ValueError(f"recording: expected a frame with at least {FEWEST} landmarks, got none")
    weights, poses = np.zeros(len(rig.names)), {}
    for i in np.flatnonzero(seen):
        poses[i] = landmark_pose(rig, sequence[i], weights, noise)
        weights = poses[i].weights
    known = np.maximum.accumulate(np.where(seen, np.arange(len(seen)), seen.argmax()))
    return [poses[i] for i in known]


def _step(rig: LandmarkRig, pixels: Floats, pose: LandmarkPose, robust_weight: Floats, noise: float) -> LandmarkPose:
    """To the minimum of the loss with the face linear in weights and pose; everything in widths of the face."""
    k = len(rig.names)
    there = robust_weight > 0
    J = _jacobian(rig, pose)[there].reshape(-1, k + _POSE)
    e = pose.errors(pixels, rig)[there].ravel()
    precision = np.repeat(robust_weight[there], 2) / noise**2
    H = (J.T * precision) @ J
    H[np.diag_indices(k)] += 1 / _SPREAD**2
    H[range(k, k + _POSE), range(k, k + _POSE)] += 1e-9 / noise**2
    start = np.r_[pose.weights, np.zeros(_POSE)]
    g = J.T @ (precision * (e + J @ start))
    g[:k] -= _SPARSITY
    low, high = np.r_[np.zeros(k), np.full(_POSE, -np.inf)], np.r_[np.ones(k), np.full(_POSE, np.inf)]
    x = bounded_quadratic(H, g, low, high, start)
    turn, growth, shift = x[k : k + 3], x[k + 3], x[k + 4 :]
    return LandmarkPose(
        x[:k],
        pose.scale * float(np.exp(growth)),
        rotation_matrix(turn) @ pose.rotation,
        pose.translation + shift * _FLIP * pose.scale * rig.width,
    )


def _jacobian(rig: LandmarkRig, pose: LandmarkPose) -> Floats:
    """Derivative (68, 2, k + 6) of the posed face, in its widths, camera frame, by weights and pose."""
    k = len(rig.names)
    seen = (rig.neutral + np.tensordot(pose.weights, rig.deltas, 1)) @ pose.rotation.T / rig.width
    x, y, z = seen.T
    J = np.zeros((68, 2, k + _POSE))
    J[:, :, :k] = np.einsum("ij,kpj->pik", pose.rotation[:2] / rig.width, rig.deltas)
    J[:, 0, k + 1], J[:, 0, k + 2] = z, -y  # a turn dw moves a point p by dw x p
    J[:, 1, k], J[:, 1, k + 2] = -z, x
    J[:, :, k + 3] = seen[:, :2]
    J[:, 0, k + 4] = J[:, 1, k + 5] = 1.0
    return J
