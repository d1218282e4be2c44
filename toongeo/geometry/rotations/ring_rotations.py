"""How the surroundings of each vertex have turned."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.geometry.one_thread import one_thread

__all__ = ["ring_rotations"]


def ring_rotations(A: sp.csr_matrix, before: NDArray[np.float64], after: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotations (n, 3, 3) that best take the edges around each vertex to what became of them.

    Minimises ``sum_j |e'_ij - R_i e_ij|^2`` over the neighbours j in the graph A (Sorkine and Alexa 2007, Eq. 5-6). A
    straight ring leaves the turn about itself open, and then the choice is arbitrary; a lonely vertex does not turn.
    """
    p, q = before - before.mean(axis=0), after - after.mean(axis=0)
    n = len(p)
    with one_thread():
        # sum_j (q_i - q_j)(p_i - p_j)^T, multiplied out into products with the graph
        degree = np.asarray(A.sum(axis=1)).reshape(n, 1, 1)
        both = q[:, :, None] * p[:, None, :]
        S = degree * both - q[:, :, None] * (A @ p)[:, None, :] - (A @ q)[:, :, None] * p[:, None, :]
        S += (A @ both.reshape(n, 9)).reshape(n, 3, 3)
        U, _, Vt = np.linalg.svd(S)
        U[:, :, 2] *= np.linalg.det(U @ Vt)[:, None]  # no reflection
        R = U @ Vt
    R[degree.ravel() == 0] = np.eye(3)
    return R
