"""The vertex graph of a triangle mesh."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components


def adjacency(F: NDArray[np.int64], n: int) -> sp.csr_matrix:
    """Symmetric 0/1 matrix (n, n) of the edges of checked triangles; a repeated index gives no loop."""
    i, j = F.ravel(), np.roll(F, -1, axis=1).ravel()
    i, j = i[i != j], j[i != j]
    A = sp.csr_matrix((np.ones(2 * len(i)), (np.concatenate([i, j]), np.concatenate([j, i]))), shape=(n, n))
    A.data[:] = 1.0  # an edge of two triangles was summed
    return A


def components(F: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """Component number (n,) of every vertex; a vertex without a triangle is a component of its own."""
    return connected_components(adjacency(F, n), directed=False)[1].astype(np.int64)
