"""The vertex graph of a triangle mesh."""

from __future__ import annotations

import igl
import numpy as np
import scipy.sparse as sp

from toongeo.arrays import Integers

__all__ = ["adjacency"]


def adjacency(F: Integers, n: int) -> sp.csr_matrix:
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
    A = igl.adjacency_matrix(F)  # of integers, with as many rows as F speaks of; symmetric, so its columns are rows
    A = sp.csr_matrix((np.ones(A.nnz), A.indices, A.indptr), shape=A.shape)
    loops = A.diagonal()
    if loops.any():
        A = sp.csr_matrix(A - sp.diags_array(loops))
    A.resize(n, n)
    return A
