"""Poisson and Laplace problems on triangles in the plane."""

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.arrays import Reals
from toongeo.geometry import cotangent_laplacian
from toongeo.geometry.operators.factor import factor_spd

__all__ = ["smooth_max", "solved"]


def solved(P: Reals, T: NDArray[np.int64], known: NDArray[np.bool_], values: Reals, source: Reals) -> Reals:
    """Functions f (n, k) with -laplacian f = source (k,) where not known; boundaries that are not known are free.

    Vertices without triangles keep their values.
    """
    n = len(P)
    stiffness = cotangent_laplacian(np.column_stack([P, np.zeros(n)]), T, clamp=1e-3).tocsr()
    u, v = P[T[:, 1]] - P[T[:, 0]], P[T[:, 2]] - P[T[:, 0]]
    area = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    mass = np.bincount(T.ravel(), np.repeat(area / 3, 3), n)
    used = np.zeros(n, bool)
    used[T] = True
    free, fixed = np.flatnonzero(used & ~known), np.flatnonzero(known)
    f = values.copy()
    if not len(free):
        return f
    matrix = (stiffness[free][:, free] + 1e-9 * sp.eye_array(len(free))).tocsc()
    right = mass[free, None] * source - stiffness[free][:, fixed] @ f[fixed]
    f[free] = factor_spd(matrix).solve(right)
    return f


def smooth_max(a: Reals, b: Reals, width: Reals) -> Reals:
    """The larger of two functions, rounded where they are less than a width apart; a little above both there."""
    return np.asarray((a + b + np.sqrt((a - b) ** 2 + width**2)) / 2)
