"""Polar decomposition of 3 x 3 matrices, many at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.geometry.operators.small_matrices import product

__all__ = ["polar_decomposition"]

_CHUNK = 16384  # matrices at a time: few enough for the cache, enough to make the calls cheap
_STEPS = 3  # of the iteration for all matrices; those that need more go on alone
_CONVERGED = 1e-7  # excess of the determinant before the last step; the error after it is its square
_SINGULAR = 1e-3  # determinant over the cubed norm, below which Newton's iteration gets slow or lost


def polar_decomposition(T: Floats, normal: Floats | None = None) -> tuple[Floats, Floats]:
    """Rotations R and symmetric S with ``T = R S``.

    Where ``det T > 0`` this is the usual decomposition with a positive S. Elsewhere R remains a rotation, and one
    eigenvalue of S is not positive: the smallest in size or, with `normal`, that whose eigenvector is nearest to it.
    (The normal component of a surface's deformation gradient changes sign where convex becomes concave; its
    tangent plane does not turn over.)

    Parameters
    ----------
    T : (3, 3, n) float
        Matrices along the last axis.
    normal : (3, n) float, optional
        Unit vectors of either sign.

    Returns
    -------
    R : (3, 3, n) float64, determinant +1
    S : (3, 3, n) float64, symmetric

    Examples
    --------
    >>> T = np.diag([2.0, 1.0, -0.5])[:, :, None]
    >>> R, S = polar_decomposition(T)
    >>> R[:, :, 0].round(9) + 0.0, S[2, 2, 0].round(9)
    (array([[1., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]]), np.float64(-0.5))
    """
    R = np.empty_like(T)
    hard = []
    for start in range(0, T.shape[2], _CHUNK):
        part = slice(start, start + _CHUNK)
        R[:, :, part], singular = _newton(T[:, :, part].copy())
        hard.append(start + singular)
    left = np.concatenate(hard)
    if len(left):
        R[:, :, left] = _by_svd(T[:, :, left], None if normal is None else normal[:, left])
    S = product(R.transpose(1, 0, 2), T)
    return R, 0.5 * (S + S.transpose(1, 0, 2))


def _newton(X: Floats) -> tuple[Floats, NDArray[np.intp]]:
    """Rotations by Newton's iteration ``X <- (X + X^-T) / 2``, and which matrices are left to the SVD."""
    C = _cofactors(X)
    determinant = _determinants(X, C)
    hard = np.flatnonzero(determinant <= _SINGULAR * (X * X).sum(axis=(0, 1)) ** 1.5)
    X[:, :, hard] = C[:, :, hard] = np.eye(3)[:, :, None]
    determinant[hard] = 1.0
    # The first step balances X against its inverse (Higham 1986); after it all singular values are near one.
    balance = np.cbrt(1 / determinant)
    return _polished(0.5 * (balance * X + C / (balance * determinant))), hard


def _polished(X: Floats) -> Floats:
    """Some steps for all matrices, then some more for those that need them.

    From the first step on no singular value is below one, so their product tells when all of them have arrived.
    """
    for _ in range(_STEPS):
        C = _cofactors(X)
        determinant = _determinants(X, C)
        C /= determinant
        X += C
        X *= 0.5
    left = np.flatnonzero(determinant > 1 + _CONVERGED)
    if len(left):
        X[:, :, left] = _polished(X[:, :, left])
    return X


def _by_svd(T: Floats, normal: Floats | None) -> Floats:
    U, _, Vt = np.linalg.svd(T.transpose(2, 0, 1))
    last = np.full(len(U), 2) if normal is None else np.abs(np.einsum("nab,bn->na", Vt, normal)).argmax(axis=1)
    rows = np.arange(len(U))
    Vt[rows, last] *= np.sign(np.linalg.det(U @ Vt))[:, None]
    return (U @ Vt).transpose(1, 2, 0)


def _cofactors(X: Floats) -> Floats:
    """``det(X) X^-T`` (3, 3, n)."""
    C = np.empty_like(X)
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        for d in range(3):
            e, f = (d + 1) % 3, (d + 2) % 3
            C[a, d] = X[b, e] * X[c, f] - X[b, f] * X[c, e]
    return C


def _determinants(X: Floats, cofactors: Floats) -> Floats:
    return (X[0] * cofactors[0]).sum(axis=0)
