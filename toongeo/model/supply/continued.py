"""Displacements of a part of a surface, continued over the rest of it."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.geometry import cotangent_laplacian
from toongeo.geometry.operators.components import components
from toongeo.geometry.operators.factor import factor_spd, solve

__all__ = ["continued"]

_PLATE_MM = 12.0  # nearer than this a bend goes on, farther away it fades: a forehead's slope must not grow into a horn


def continued(
    V: NDArray[np.float64], F: NDArray[np.int64], known: NDArray[np.bool_], fields: NDArray[np.floating]
) -> NDArray[np.float32]:
    """Fields (k, n, 3) that keep their values where known, and go on as smoothly as can be elsewhere.

    They minimise the energy of a thin plate under tension, ``sum |L u|^2 / A + u . L u / l^2``, l = 12 mm:
    smooth across the border of what is known, and constant far from it. Pieces of the surface of which nothing is known
    keep what they have.

    Parameters
    ----------
    V : (n, 3) float, mm
    F : (m, 3) int
    known : (n,) bool
    fields : (k, n, 3) float

    Examples
    --------
    >>> x, y = np.meshgrid(np.arange(20.0), np.arange(3.0))
    >>> V = np.column_stack([x.ravel(), y.ravel(), np.zeros(60)])
    >>> a = (np.arange(2)[:, None] * 20 + np.arange(19)).ravel()
    >>> F = np.vstack([np.column_stack([a, a + 1, a + 20]), np.column_stack([a + 1, a + 21, a + 20])])
    >>> found = continued(V, F, V[:, 0] < 5, np.full((1, 60, 3), 2.0) * (V[:, :1] < 5))
    >>> bool(np.abs(found - 2).max() < 1e-6)
    True
    """
    filled = np.array(fields, np.float32)
    piece = components(F, len(V))
    held = np.zeros(piece.max() + 1, bool)
    held[piece[known]] = True
    free = np.flatnonzero(~known & held[piece])
    if not len(free):
        return filled
    L = cotangent_laplacian(V, F, clamp=0.05)
    corners = V[F]
    double = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    area = np.bincount(F.ravel(), np.repeat(double / 6, 3), minlength=len(V))
    area = np.maximum(area, 0.1 * area.mean())
    rows = (L.T @ sp.diags_array(1 / area) @ L + L / _PLATE_MM**2).tocsr()[free]
    rest = np.setdiff1d(np.arange(len(V)), free)
    flat = filled.transpose(1, 0, 2).reshape(len(V), -1).astype(np.float64)
    found = solve(factor_spd(rows[:, free]), -(rows[:, rest] @ flat[rest]))
    filled[:, free] = found.reshape(len(free), -1, 3).transpose(1, 0, 2)
    return filled
