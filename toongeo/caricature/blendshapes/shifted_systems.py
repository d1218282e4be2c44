"""Many systems that differ in a multiple of the identity."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from toongeo.arrays import Floats
from toongeo.geometry.operators.factor import factor_spd, solve

__all__ = ["shifted_solutions"]

_TOLERANCE = 1e-10  # of the residual against the right-hand side
_ROUNDS = 60  # of conjugate gradients at most
_FLOOR = 1e-11  # of the mean diagonal entry: added to all, so that what nothing holds stays at rest


def shifted_solutions(A: sp.spmatrix, shifts: Floats, B: Floats) -> Floats:
    """``(A + s_l I)^-1 B[:, l]`` for every shift, by conjugate gradients with one factor as the preconditioner.

    Parameters
    ----------
    A : (n, n) sparse, symmetric positive semi-definite
    shifts : (l,) float >= 0
    B : (n, l, c) float

    Returns
    -------
    (n, l, c) float64
    """
    A = sp.csr_matrix(A)
    n, _, width = B.shape
    floor = _FLOOR * A.diagonal().mean()
    s = np.repeat(shifts + floor, width)
    factor = factor_spd(A + (np.median(shifts) + floor) * sp.eye_array(n))
    right = B.reshape(n, -1)
    x = np.zeros_like(right)
    residual = right.copy()
    size = np.sqrt((right**2).sum(axis=0))
    active = np.flatnonzero(size > 0)
    direction, before = np.zeros_like(right), np.ones(len(s))
    for step in range(_ROUNDS):
        if not len(active):
            break
        r = residual[:, active]
        z = solve(factor, r)
        rz = (r * z).sum(axis=0)
        d = z + (rz / before[active] if step else 0.0) * direction[:, active]
        before[active], direction[:, active] = rz, d
        Ad = A @ d + s[active] * d
        length = rz / (d * Ad).sum(axis=0)
        x[:, active] += length * d
        residual[:, active] = r - length * Ad
        active = active[np.sqrt((residual[:, active] ** 2).sum(axis=0)) > _TOLERANCE * size[active]]
    return x.reshape(B.shape)
