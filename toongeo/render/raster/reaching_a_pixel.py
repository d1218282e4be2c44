"""Which faces can be seen at all."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats, Integers

__all__ = ["reaching_a_pixel"]

_MARGIN = 1e-3  # px, above what a face may grow by


def reaching_a_pixel(points: Floats, faces: Integers, height: int, width: int) -> Integers:
    """Rows of the faces whose bounding box holds a pixel centre: small pictures drop most of them here."""
    keep = np.ones(len(faces), bool)
    for axis, size in enumerate((width, height)):
        a, b, c = (points[:, axis][faces[:, corner]] for corner in range(3))
        first = np.ceil(np.minimum(np.minimum(a, b), c) - _MARGIN)
        last = np.floor(np.maximum(np.maximum(a, b), c) + _MARGIN)
        keep &= np.maximum(first, 0.0) <= np.minimum(last, size - 1.0)
    return np.flatnonzero(keep)
