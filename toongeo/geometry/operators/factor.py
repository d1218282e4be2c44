"""Sparse Cholesky-like factors by SuperLU, set up for symmetric positive definite matrices."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import SuperLU, splu

from toongeo.geometry.one_thread import one_thread

__all__ = ["factor_spd", "solve"]

# Right-hand sides a call: supernodes make a few at once cheaper than one by one, many fall out of the cache.
_CHUNK = 16


def factor_spd(A: sp.spmatrix) -> SuperLU:
    """Factor a symmetric positive definite matrix without pivoting.

    The ordering alone is not enough: with SuperLU's default pivoting the fill-in explodes.
    """
    with one_thread():
        symmetric = {"SymmetricMode": True}
        return splu(sp.csc_matrix(A), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=symmetric)


def solve(factor: SuperLU, B: NDArray[np.float64]) -> NDArray[np.float64]:
    """``A^-1 B`` for (n, k) right-hand sides."""
    X = np.empty(B.shape)
    with one_thread():
        for start in range(0, B.shape[1], _CHUNK):
            X[:, start : start + _CHUNK] = factor.solve(B[:, start : start + _CHUNK])
    return X
