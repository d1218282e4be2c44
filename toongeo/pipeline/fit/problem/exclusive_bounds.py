"""Bounds that leave at most one of two opposite expressions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats

__all__ = ["exclusive_bounds"]


def exclusive_bounds(upper: Floats, x: Floats, pairs: NDArray[np.int64]) -> Floats:
    """Upper bounds (n,) that hold the lesser variable of each pair (p, 2) at zero where both are above it.

    Both are held where they are equal, so that a mirrored face is held alike.

    Examples
    --------
    >>> exclusive_bounds(np.ones(4), np.array([0.2, 0.5, 0.0, 0.3]), np.array([[0, 1], [2, 3]]))
    array([0., 1., 1., 1.])
    """
    held = upper.copy()
    for pair in pairs:
        values = x[pair]
        if values.min() > 0:
            held[pair[(values < values.max()) | (values[0] == values[1])]] = 0.0
    return held
