"""Masks from polygons, and masks grown and shrunken."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Mask

__all__ = ["Mask", "filled", "grown", "signed_distance"]


def filled(shape: tuple[int, ...], polygon: NDArray[np.floating]) -> Mask:
    """Pixels (h, w) bool of a polygon (k, 2) px, its border among them."""
    mask = np.zeros(shape[:2], np.uint8)
    cv2.fillPoly(mask, [np.rint(polygon * 16).astype(np.int32)], 1, shift=4)
    return mask.astype(bool)


def grown(mask: Mask, radius: float) -> Mask:
    """Pixels within a radius, px, of a mask; of a negative one, those of the mask that are farther from its outside."""
    if radius < 0:
        return ~grown(~mask, -radius)
    if not mask.any():
        return mask.copy()
    away = cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    return np.asarray(away <= radius, np.bool_)


def signed_distance(mask: Mask) -> NDArray[np.float32]:
    """Distance (h, w), px, to the border of a mask, positive inside."""
    inside = cv2.distanceTransform(mask.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_3)
    outside = cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_3)
    return np.asarray(inside - outside, np.float32)
