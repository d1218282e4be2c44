"""The vertex graph of a triangle mesh."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

__all__ = ["adjacency"]


def adjacency(F: NDArray[np.int64], n: int) -> sp.csr_matrix:
    """Symmetric 0/1 matrix of the edges of a mesh.

    Parameters
    ----------
    F : (m, 3) int
        Triangles, not checked; a repeated index gives no loop.
    n : int
        Number of vertices.

    Returns
    -------
    (n, n) csr_matrix of float64
        1 where an edge joins two vertices.

    Examples
    --------
    >>> adjacency(np.array([[0, 1, 2]]), 4).toarray()
    array([[0., 1., 1., 0.],
           [1., 0., 1., 0.],
           [1., 1., 0., 0.],
           [0., 0., 0., 0.]])
    """
    i, j = F.ravel(), np.roll(F, -1, axis=1).ravel()
    i, j = i[i != j], j[i != j]
    A = sp.csr_matrix((np.ones(2 * len(i)), (np.concatenate([i, j]), np.concatenate([j, i]))), shape=(n, n))
    A.data[:] = 1.0  # an edge of two triangles was summed
    return A
