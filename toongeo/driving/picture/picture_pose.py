"""Pose and expression of a known face from the grey values of one frame.

Constants were chosen as those of ``skin_samples``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import cv2
import numpy as np

from toongeo.arrays import Floats
from toongeo.driving.landmarks.landmark_pose import LandmarkPose
from toongeo.driving.picture.skin_samples import BLURS_PX, Grey, SkinSamples, blurred, posed_px
from toongeo.geometry.operators.bounded_quadratic import bounded_quadratic
from toongeo.geometry.rotations.rotation_vectors import rotation_matrix
from toongeo.render import sample_image

__all__ = ["Steps", "picture_error", "picture_pose", "slopes"]

Steps = tuple[int, int]
_POSE = 6  # rotation vector, log scale, translation
_FLIP = np.array([1.0, -1.0])
_OUTLIERS = (1.0, 0.7)  # contrasts at which an error counts a quarter, by blur
_ERROR = 0.1  # s.d. of a grey value at least, in contrasts: what light and a face not quite known leave
_SHARED = 0.04  # of the samples that count as if they erred by themselves: neighbours err together
_SPREAD = 1.0  # s.d. of a weight before anything is seen
_SPARSITY = 1.0  # how much a weight of 1 costs beside: few expressions explain a face better than many
_CALM = 0.5  # s.d. of a weight's change from where it starts: a frame is much like the one before
_EDGE = 0.3  # cosine between skin and the line of sight from which on it counts in full
_LIGHT_MM = 50.0  # over which light may rise and fall


class _Sight(NamedTuple):
    """Grey values and their slopes (s, 3) at the samples of a face in a pose, and where these are, mm, camera frame."""

    values: Floats
    camera: Floats


def slopes(frame: Grey) -> list[Grey]:
    """(h, w, 3) for each of ``BLURS_PX``: grey values and their slopes a px to the right and down."""
    levels = [blurred(frame, blur) for blur in BLURS_PX]
    return [
        np.dstack([g, *(cv2.Sobel(g, cv2.CV_32F, *axis, scale=1 / 8) for axis in ((1, 0), (0, 1)))]) for g in levels
    ]


def picture_pose(
    skin: SkinSamples,
    levels: list[Grey],
    start: LandmarkPose,
    *,
    least: float = 0.0,
    steps: Steps = (4, 3),
    held: Sequence[int] = (),
) -> LandmarkPose:
    """The scaled orthographic pose and the weights under which a face looks most like it does at rest.

    Gauss-Newton on the difference between grey values of the frame and those of the samples under an unknown light
    (a factor that is linear across the face, and an offset, which are projected out) over weights and pose together,
    from blurred pictures to sharp ones. What no expression explains loses influence (Geman and McClure).

    Parameters
    ----------
    skin : SkinSamples
    levels : as of :func:`slopes`
    start : LandmarkPose
    least : float <= 0
        Of a weight. Below 0 where the frame of the samples may show an expression itself; few expressions are not
        preferred to many then.
    steps : (int, int)
        By blur.
    held : sequence of int
        Weights that stay as they are at the start.

    References
    ----------
    S. Baker, I. Matthews, "Lucas-Kanade 20 years on", IJCV 56 (2004), for the forward additive step; light projected
    out as in G. Hager, P. Belhumeur, PAMI 20 (1998).
    """
    pose = start
    for level, count in enumerate(steps):
        for _ in range(count):
            pose = _step(skin, levels, level, pose, start.weights, least, held)
    return pose


def picture_error(skin: SkinSamples, levels: list[Grey], pose: LandmarkPose, level: int = 0) -> float:
    """How unlike the samples a frame looks in a pose: 0 to 1."""
    sight = _sight(skin, levels[level], pose)
    errors, _ = _under_light(sight.values[:, 0], _lights(skin, level), _OUTLIERS[level])
    return float(np.mean(errors**2 / (errors**2 + _OUTLIERS[level] ** 2)))


def _step(
    skin: SkinSamples,
    levels: list[Grey],
    level: int,
    pose: LandmarkPose,
    before: Floats,
    least: float,
    held: Sequence[int],
) -> LandmarkPose:
    k = len(before)
    sight, lights = _sight(skin, levels[level], pose), _lights(skin, level)
    errors, robust_weight = _under_light(sight.values[:, 0], lights, _OUTLIERS[level])
    facing = np.clip(skin.normals @ pose.rotation[2] / _EDGE, 0, 1)
    root = np.sqrt(robust_weight * facing)[:, None]
    J = _jacobian(skin, sight, pose) * root
    lit = np.linalg.qr(lights * root)[0]
    J -= lit @ (lit.T @ J)  # what a change of light would do as well
    precision = _SHARED / max(_ERROR, float(np.median(np.abs(errors))) / 0.6745) ** 2
    H = precision * (J.T @ J)
    start = np.r_[pose.weights, np.zeros(_POSE)]
    g = H @ start - precision * (J.T @ (errors[:, None] * root)[:, 0])
    H[np.diag_indices(k)] += 1 / _SPREAD**2 + 1 / _CALM**2
    H[range(k, k + _POSE), range(k, k + _POSE)] += 1.0  # a step of a radian or a width is unheard of
    g[:k] += before / _CALM**2 - _SPARSITY * (least == 0)
    low, high = np.r_[np.full(k, least), np.full(_POSE, -np.inf)], np.r_[np.ones(k), np.full(_POSE, np.inf)]
    low[list(held)] = high[list(held)] = before[list(held)]
    x = bounded_quadratic(H, g, low, high, start)
    turn, growth, shift = x[k : k + 3], x[k + 3], x[k + 4 :]
    return LandmarkPose(
        x[:k],
        pose.scale * float(np.exp(growth)),
        rotation_matrix(turn) @ pose.rotation,
        pose.translation + shift * _FLIP * pose.scale * skin.rig.width,
    )


def _sight(skin: SkinSamples, level: Grey, pose: LandmarkPose) -> _Sight:
    shape = skin.shape(pose.weights)
    values = sample_image(level, posed_px(shape, pose)).astype(np.float64)
    return _Sight(values, shape @ pose.rotation.T)


def _lights(skin: SkinSamples, level: int) -> Floats:
    """(s, 4): how the grey values look under lights that are even, rise to the left or upwards, and as an offset."""
    grey, across = skin.greys[level][:, None], (skin.rest[:, :2] - skin.rest[:, :2].mean(axis=0)) / _LIGHT_MM
    return np.hstack([grey, grey * across, np.ones_like(grey)])


def _under_light(values: Floats, lights: Floats, outlier: float) -> tuple[Floats, Floats]:
    """What the best light leaves of grey values (s,), and how far each sample is to be believed."""
    weight = np.ones(len(values))
    for _ in range(3):
        root = np.sqrt(weight)
        light = np.linalg.lstsq(lights * root[:, None], values * root, rcond=None)[0]
        errors = values - lights @ light
        weight = 1 / (1 + (errors / outlier) ** 2) ** 2
    return errors, weight


def _jacobian(skin: SkinSamples, sight: _Sight, pose: LandmarkPose) -> Floats:
    """Derivative (s, k + 6) of the grey values by weights and pose; shifts in widths of the face."""
    along = pose.scale * sight.values[:, 1:] * _FLIP  # a mm to the left of the subject, and up
    x, y, z = sight.camera.T
    right, up = along.T
    moved = np.matmul((along @ pose.rotation[:2])[:, None], skin.deltas)[:, 0]
    turned = np.column_stack([-up * z, right * z, up * x - right * y])  # a turn dw moves a point p by dw x p
    return np.hstack([moved, turned, (right * x + up * y)[:, None], along * skin.rig.width])
