"""Sparse Cholesky-like factors by SuperLU, set up for symmetric positive definite matrices."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from toongeo.geometry.one_thread import one_thread

__all__ = ["SpdFactor", "factor_spd", "solve"]

# Right-hand sides a call: supernodes make a few at once cheaper than one by one, many fall out of the cache.
_CHUNK = 16


class SpdFactor:
    """The factor of a symmetric positive definite matrix, without pivoting; a copy or a pickle of it factors anew.

    The ordering alone is not enough: with SuperLU's default pivoting the fill-in explodes.

    Raises
    ------
    ValueError
        If the matrix is singular.
    """

    def __init__(self, A: sp.csc_matrix) -> None:
        self._A = A
        with one_thread():
            symmetric = {"SymmetricMode": True}
            try:
                self._factor = splu(A, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=symmetric)
            except RuntimeError as error:  # a pivot that is exactly 0
                raise ValueError(
                    "V, F: expected a mesh whose equations can be solved, got one whose system is singular: triangles "
                    "too thin, or sizes too different, for double precision"
                ) from error

    def __reduce__(self) -> tuple[type, tuple[sp.csc_matrix]]:
        return SpdFactor, (self._A,)

    def solve(self, b: NDArray[np.float64]) -> NDArray[np.float64]:
        """``A^-1 b`` for (n,) or (n, k) right-hand sides, at once."""
        return np.asarray(self._factor.solve(b))


def factor_spd(A: sp.spmatrix) -> SpdFactor:
    """Factor a symmetric positive definite matrix without pivoting."""
    return SpdFactor(sp.csc_matrix(A))


def solve(factor: SpdFactor, B: NDArray[np.float64]) -> NDArray[np.float64]:
    """``A^-1 B`` for (n, k) right-hand sides."""
    X = np.empty(B.shape)
    with one_thread():
        for start in range(0, B.shape[1], _CHUNK):
            X[:, start : start + _CHUNK] = factor.solve(B[:, start : start + _CHUNK])
    return X
