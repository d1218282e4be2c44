"""The upright crop of a face, and descriptors in it."""

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.search.orientation_maps import orientation_maps

__all__ = ["CROP_PX", "RADIUS_PX", "SAMPLES", "face_crop", "point_descriptors"]

CROP_PX = 160
RADIUS_PX = 38.0  # root mean square radius of the 68 points in the crop
_CELL = 2  # px
_PREBLUR = 0.8  # px
_RING = 8
_INNER_RING = 0.45  # of the radius
SAMPLES = 1 + 2 * _RING
_ANGLES = np.arange(_RING) * (2 * np.pi / _RING)
_UNIT = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)])
_OFFSETS = np.vstack([np.zeros((1, 2)), _INNER_RING * _UNIT, _UNIT])
_FLOOR = 2.0  # grey levels: below this gradients are noise


def face_crop(grey: np.ndarray, matrix: NDArray[np.float64], size: int = CROP_PX) -> np.ndarray:
    """(size, size) of the picture under a (2, 3) similarity; it may shrink only a little: nothing is antialiased."""
    return cv2.warpAffine(grey, matrix, (size, size), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


def point_descriptors(
    crop: np.ndarray, points: NDArray[np.float64], radius: float, blurs: tuple[float, float]
) -> NDArray[np.float32]:
    """(k, 17 * 8) float32: orientation maps at each point (k, 2), in a ring near it and in one of a radius (px).

    The far ring is read from maps with the second blur (px), the others from maps with the first.
    """
    maps = orientation_maps(crop, _CELL, _PREBLUR)
    near, far = ([cv2.GaussianBlur(half, (0, 0), blur / _CELL) for half in maps] for blur in blurs)
    places = points[:, None] + radius * _OFFSETS
    side = crop.shape[0] // _CELL
    cells = np.clip(np.rint((places - 0.5) / _CELL).astype(np.int64), 0, side - 1)
    index = cells[..., 1] * side + cells[..., 0]
    split = 1 + _RING
    out = np.empty((len(points), SAMPLES, 8), np.float32)
    for k in range(2):
        out[:, :split, 4 * k : 4 * k + 4] = near[k].reshape(-1, 4)[index[:, :split]]
        out[:, split:, 4 * k : 4 * k + 4] = far[k].reshape(-1, 4)[index[:, split:]]
    rows = np.sqrt(np.maximum(out.reshape(len(points), -1), 0))
    return rows / (np.sqrt(np.einsum("kd,kd->k", rows, rows)) + np.float32(_FLOOR))[:, None]
