"""Where faces may be: linear templates on orientation histograms over a pyramid."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.search.orientation_maps import DIRECTIONS, orientation_maps

__all__ = ["BOX_RADIUS_PX", "WINDOW_PX", "BoxTemplates", "box_descriptor", "face_boxes"]

CELL_PX = 8
_CELLS = 12
WINDOW_PX = CELL_PX * _CELLS
BOX_RADIUS_PX = 26.0  # root mean square radius of the 68 points in the window: a face with some hair and chin around
_BLUR = 0.7  # px
_FLOOR = 1.0  # grey levels
_LONGEST_PX = 480  # of the picture that is searched
_SMALLEST, _LARGEST, _STEP = 0.04, 0.42, 1.2  # radius as a share of the shorter side
_LEAST_PX = 6.0
_A_LEVEL = 12  # candidates kept of each level
_SAME_PLACE, _SAME_SIZE = 0.5, 0.35  # boxes nearer than that, in radii and in log size, are one


@dataclass(frozen=True, eq=False)
class BoxTemplates:
    """Linear classifiers of windows, one a view: `weights` (v, 1152) and `offsets` (v,) float32."""

    weights: NDArray[np.float32]
    offsets: NDArray[np.float32]


def face_boxes(grey: np.ndarray, templates: BoxTemplates, count: int) -> NDArray[np.float64]:
    """The best boxes (k <= count, 4), the best first: x, y, radius in px, and the score.

    N. Dalal, B. Triggs, "Histograms of oriented gradients for human detection", CVPR 2005.
    """
    shrink = min(1.0, _LONGEST_PX / max(grey.shape))
    small = _resized(grey, shrink)
    shorter = min(small.shape)
    radius, found = _LARGEST * shorter, [np.zeros((0, 4))]
    while radius >= max(_SMALLEST * shorter, _LEAST_PX):
        found.append(_level(small, BOX_RADIUS_PX / radius, templates))
        radius /= _STEP
    every = np.concatenate(found)
    every[:, :2] = (every[:, :2] + 0.5) / shrink - 0.5
    every[:, 2] /= shrink
    kept: list[NDArray[np.float64]] = []
    for box in every[np.argsort(-every[:, 3], kind="stable")]:
        if not any(_same(box, other) for other in kept):
            kept.append(box)
        if len(kept) == count:
            break
    return np.array(kept).reshape(-1, 4)


def box_descriptor(window: np.ndarray) -> NDArray[np.float32]:
    """(1152,) of one window (96, 96)."""
    return _histograms(window).ravel()


def _level(grey: np.ndarray, scale: float, templates: BoxTemplates) -> NDArray[np.float64]:
    """The best boxes (k, 4) of one size, in px of `grey`."""
    pad = WINDOW_PX // 3  # faces may be cut off
    level = cv2.copyMakeBorder(_resized(grey, scale), pad, pad, pad, pad, cv2.BORDER_REPLICATE)
    level = level[: level.shape[0] // CELL_PX * CELL_PX, : level.shape[1] // CELL_PX * CELL_PX]
    if min(level.shape) < WINDOW_PX:
        return np.zeros((0, 4))
    windows = sliding_window_view(_histograms(level), (_CELLS, _CELLS), axis=(0, 1))
    rows = windows.transpose(0, 1, 3, 4, 2).reshape(-1, _CELLS * _CELLS * DIRECTIONS)
    scores = (rows @ templates.weights.T + templates.offsets).max(axis=1)
    best = np.argsort(-scores, kind="stable")[:_A_LEVEL]
    y, x = np.divmod(best, windows.shape[1])
    corner = np.column_stack([x, y]) * CELL_PX + (WINDOW_PX / 2 - pad - 0.5)
    middle = (corner + 0.5) / scale - 0.5
    return np.column_stack([middle, np.full(len(best), BOX_RADIUS_PX / scale), scores[best]])


def _histograms(grey: np.ndarray) -> NDArray[np.float32]:
    """(h / 8, w / 8, 8), normalised by their surroundings."""
    cells = np.concatenate(orientation_maps(grey, CELL_PX, _BLUR), axis=2)
    energy = cv2.blur(np.einsum("yxk,yxk->yx", cells, cells), (5, 5), borderType=cv2.BORDER_REPLICATE)
    return np.minimum(np.sqrt(cells / (np.sqrt(np.maximum(energy, 0)) + _FLOOR)[..., None]), 1.5)


def _resized(grey: np.ndarray, scale: float) -> np.ndarray:
    size = [max(1, round(side * scale)) for side in grey.shape[::-1]]
    return cv2.resize(grey, size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)


def _same(box: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
    near = np.hypot(*(box[:2] - other[:2])) < _SAME_PLACE * max(box[2], other[2])
    return bool(near and abs(np.log(box[2] / other[2])) < _SAME_SIZE)
