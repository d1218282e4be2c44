"""The last step to the edge of an eye.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/snapping.py``).
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats

__all__ = ["refine_lids"]

_LEVELS = np.arange(-5.0, 5.01, 0.5)  # px along the outward normal
_BANDS = np.array([1.0, 2.0, 3.0])  # px on both sides that are compared
_BEND, _LEAVE = 0.2, 0.1  # cost of a step between neighbours, per half px squared; of a px squared away
_SMOOTH = np.array([1.0, 2.0, 3.0, 2.0, 1.0]) / 9


def refine_lids(channels: NDArray[np.float32], contour: Floats) -> Floats:
    """Closed contour (n, 2) px of the patch, moved along its normals to where eye becomes skin.

    The displacements are the cheapest closed path over all samples and levels, by dynamic programming.
    """
    along = np.roll(contour, -1, axis=0) - np.roll(contour, 1, axis=0)
    normal = np.column_stack([along[:, 1], -along[:, 0]])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True) + 1e-9
    if ((contour - contour.mean(axis=0)) * normal).sum() < 0:
        normal = -normal
    eye = np.ascontiguousarray(channels[..., 0])
    inside, outside = (
        np.mean([_sampled(eye, contour, normal, _LEVELS + sign * band) for band in _BANDS], axis=0) for sign in (-1, 1)
    )
    moved = _LEVELS[_cheapest_ring(outside - inside + _LEAVE * _LEVELS**2)]
    reach = len(_SMOOTH) // 2
    moved = np.convolve(np.r_[moved[-reach:], moved, moved[:reach]], _SMOOTH, "valid")
    return contour + normal * moved[:, None]


def _sampled(plane: NDArray[np.float32], contour: Floats, normal: Floats, levels: Floats) -> Floats:
    """Values (n, levels) of a plane along the normals."""
    points = (contour[:, None] + normal[:, None] * levels[:, None]).astype(np.float32)
    x, y = np.ascontiguousarray(points[..., 0]), np.ascontiguousarray(points[..., 1])
    return np.asarray(cv2.remap(plane, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE), np.float64)


def _cheapest_ring(cost: Floats) -> NDArray[np.intp]:
    """Level of each of n samples: the closed path with the least sum of ``cost`` (n, m) and bending.

    The first pass opens the ring; the second is held, at the sample opposite, where the first one went.
    """
    n, m = cost.shape
    levels = np.arange(m, dtype=np.float64)
    step = _BEND * (levels[:, None] - levels) ** 2
    opposite = _cheapest_path(cost, step, None)[n // 2]
    turned = np.roll(cost, -(n // 2), axis=0)
    return np.roll(_cheapest_path(turned, step, opposite), n // 2)


def _cheapest_path(cost: Floats, step: Floats, end: int | None) -> NDArray[np.intp]:
    """Viterbi path; it starts at ``end`` and must be able to come back there, if given."""
    n, m = cost.shape
    total = cost[0].copy()
    if end is not None:
        total[np.arange(m) != end] = np.inf
    origin = np.zeros((n, m), np.intp)
    for k in range(1, n):
        through = total[None] + step
        origin[k] = through.argmin(axis=1)
        total = through[np.arange(m), origin[k]] + cost[k]
    path = np.empty(n, np.intp)
    path[-1] = (total if end is None else total + step[end]).argmin()
    for k in range(n - 1, 0, -1):
        path[k - 1] = origin[k, path[k]]
    return path
