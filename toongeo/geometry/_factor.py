"""Sparse Cholesky-like factors by SuperLU, set up for symmetric positive definite matrices."""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import SuperLU, splu
from threadpoolctl import ThreadpoolController

# Right-hand sides a call: supernodes make a few at once cheaper than one by one, many fall out of the cache.
_CHUNK = 16


@cache
def _threadpools() -> ThreadpoolController:
    return ThreadpoolController()  # looking for the libraries takes milliseconds: once is enough


def one_blas_thread() -> AbstractContextManager[object]:
    """Context in which BLAS runs one thread: on small blocks several threads wait for each other."""
    return _threadpools().limit(limits=1, user_api="blas")


def factor_spd(A: sp.spmatrix) -> SuperLU:
    """Factor a symmetric positive definite matrix without pivoting.

    The ordering alone is not enough: with SuperLU's default pivoting the fill-in explodes.
    """
    with one_blas_thread():
        symmetric = {"SymmetricMode": True}
        return splu(sp.csc_matrix(A), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=symmetric)


def solve(factor: SuperLU, B: NDArray[np.float64]) -> NDArray[np.float64]:
    """``A^-1 B`` for (n, k) right-hand sides."""
    X = np.empty(B.shape)
    with one_blas_thread():
        for start in range(0, B.shape[1], _CHUNK):
            X[:, start : start + _CHUNK] = factor.solve(B[:, start : start + _CHUNK])
    return X
