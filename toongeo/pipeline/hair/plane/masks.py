"""Masks on the raster of the plane: distances, and shapes that are opened, closed and sorted out."""

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Mask
from toongeo.pipeline.hair.plane.working_plane import CELL_MM

__all__ = [
    "closed",
    "depth_inside",
    "dilated",
    "eroded",
    "large_pieces",
    "nearest_set",
    "opened",
    "signed",
    "without_holes",
]

Floats = NDArray[np.floating]


def depth_inside(mask: Mask) -> Floats:
    """mm (rows, columns) from each set cell to the nearest that is not; 0 at those."""
    away = cv2.distanceTransform(np.ascontiguousarray(mask, np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return np.asarray(away, np.float64) * CELL_MM


def signed(mask: Mask) -> Floats:
    """Signed distance, mm, to the outline of a mask; > 0 inside."""
    return depth_inside(mask) - depth_inside(~mask)


def opened(mask: Mask, radius_mm: float) -> Mask:
    """What of a mask a disc reaches that fits into it."""
    return dilated(eroded(mask, radius_mm), radius_mm)


def closed(mask: Mask, radius_mm: float) -> Mask:
    """A mask without gaps into which no disc fits."""
    return eroded(dilated(mask, radius_mm), radius_mm)


def dilated(mask: Mask, radius_mm: float) -> Mask:
    return depth_inside(~mask) <= radius_mm if mask.any() else mask.copy()


def eroded(mask: Mask, radius_mm: float) -> Mask:
    """Cells farther than the radius from all that are not set; beyond the raster nothing is."""
    return depth_inside(np.pad(mask, 1))[1:-1, 1:-1] > radius_mm


def large_pieces(mask: Mask, share: float) -> Mask:
    """Pieces with more than a share of the cells that the largest has."""
    _, pieces, statistics, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=4)
    cells = statistics[:, cv2.CC_STAT_AREA].copy()
    cells[0] = 0
    kept = cells > share * cells.max()
    kept[0] = False
    return np.asarray(kept[pieces])


def without_holes(mask: Mask, most_mm2: float = np.inf) -> Mask:
    """A mask whose holes of at most so many mm2 are set; what reaches the raster's border is no hole."""
    _, pieces, statistics, _ = cv2.connectedComponentsWithStats((~np.pad(mask, 1)).astype(np.uint8), connectivity=4)
    hole = statistics[:, cv2.CC_STAT_AREA] * CELL_MM**2 <= most_mm2
    hole[[0, pieces[0, 0]]] = False
    return mask | np.asarray(hole[pieces])[1:-1, 1:-1]


def nearest_set(values: NDArray[Any], mask: Mask) -> NDArray[Any]:
    """A raster whose cells all have the value of the nearest set cell."""
    if not mask.any():
        return values.copy()
    _, labels = cv2.distanceTransformWithLabels(
        (~mask).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
    )
    flat = np.zeros(labels.max() + 1, np.int64)
    at = np.flatnonzero(mask)
    flat[labels.ravel()[at]] = at
    return np.asarray(values.reshape(mask.size, -1)[flat[labels.ravel()]].reshape(values.shape))
