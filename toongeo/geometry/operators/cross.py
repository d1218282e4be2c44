"""Cross product of coordinate rows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["cross"]


def cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """``a x b`` for (3, ...) arrays with the coordinate as first axis; much faster than `np.cross`."""
    out = np.empty(np.broadcast_shapes(a.shape, b.shape))
    np.subtract(a[1] * b[2], a[2] * b[1], out=out[0])
    np.subtract(a[2] * b[0], a[0] * b[2], out=out[1])
    np.subtract(a[0] * b[1], a[1] * b[0], out=out[2])
    return out
