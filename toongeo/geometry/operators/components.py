"""Connected components of checked triangles."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from toongeo.geometry.operators.adjacency import adjacency

__all__ = ["components"]


def components(F: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """Component number (n,) of every vertex; a vertex without a triangle is a component of its own."""
    return connected_components(adjacency(F, n), directed=False)[1].astype(np.int64)
