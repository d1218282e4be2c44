"""The uniform (umbrella) Laplacian of a triangle mesh."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from toongeo.geometry.operators.adjacency import adjacency
from toongeo.geometry.validate_mesh import validate_faces

__all__ = ["uniform_laplacian"]


def uniform_laplacian(F: ArrayLike, n: int) -> sp.csr_matrix:
    """``L = I - D^-1 A``: each vertex minus the mean of its neighbours (Pan et al. 2024, Eq. 9).

    Positive sign on the diagonal. It knows the connectivity only, so degenerate triangles do no harm, and
    it is not symmetric: its eigenvalues are real and in [0, 2], its null space is spanned by the indicators
    of the connected components.

    Parameters
    ----------
    F : (m, 3) int
        Triangles.
    n : int
        Number of vertices.

    Returns
    -------
    (n, n) csr_matrix of float64
        The row of a vertex without a triangle is zero.

    Raises
    ------
    ValueError
        If `F` is not (m, 3) or an index is out of range.

    Examples
    --------
    >>> uniform_laplacian([[0, 1, 2]], 3).toarray()
    array([[ 1. , -0.5, -0.5],
           [-0.5,  1. , -0.5],
           [-0.5, -0.5,  1. ]])
    """
    A = adjacency(validate_faces(F, n), n)
    valence = np.diff(A.indptr)
    # Eq. 9: L(v_i) = 1/|N(v_i)| sum_j (v_i - v_j)
    A.data = np.repeat(1.0 / np.maximum(valence, 1), valence)
    return sp.csr_matrix(sp.diags_array((valence > 0).astype(float)) - A)
