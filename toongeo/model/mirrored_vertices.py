"""The other side of a face, vertex by vertex."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

__all__ = ["mirrored_vertices"]


def mirrored_vertices(mean: NDArray[np.float64]) -> NDArray[np.int64]:
    """For every vertex (n,) the one nearest to its mirror image; on a symmetric mesh it is the image.

    Examples
    --------
    >>> mirrored_vertices(np.array([[-2.0, 1, 0], [0, 0, 0], [2, 1, 0]]))
    array([2, 1, 0])
    """
    return np.asarray(cKDTree(mean).query(mean * [-1.0, 1.0, 1.0])[1], np.int64)
