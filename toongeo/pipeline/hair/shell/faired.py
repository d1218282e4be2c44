"""The shell smoothed as a surface in space."""

from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.arrays import Integers, Mask
from toongeo.pipeline.hair.shell.edges import boundary_edges, edges_of
from toongeo.pipeline.hair.shell.sheet_rasters import SheetRasters
from toongeo.pipeline.hair.shell.sheets import Sheets

__all__ = ["faired"]

Floats = NDArray[np.floating]

_ROUNDS, _SHRINK, _SWELL = 20, 0.5, -0.51  # of Taubin 1995: a round keeps what is broad as large as it was
_FLOOR_MM2 = 1.0  # added to squared lengths of edges, so that none counts for all
_THICK_MM = (4.0, 12.0)  # of a shell whose points may leave their place in the plane: thin strands keep it
_FLATTENED = 0.2  # of a triangle's area in the plane is left at least
_CLEAR_MM = 1.0  # of hair over what the skin reaches
_APART_MM = 1.5  # between the sheets, unless they were nearer before


def faired(both: Sheets, rasters: SheetRasters) -> Sheets:
    """The sheets, whose walls no longer repeat every notch of the outline.

    The rim moves in depth only, which keeps the silhouette; lines on the skin stay. Points move in the plane for both
    sheets alike, and no triangle turns over there, so that both remain heights over the same triangles.
    """
    P, T = both.points, both.triangles
    n = len(P)
    rim = np.zeros(n, bool)
    rim[boundary_edges(T)] = True
    behind = np.where(rim, np.arange(n), n + np.arange(n))
    X = np.vstack([np.column_stack([P, both.front]), np.column_stack([P, both.back])])
    free = [_inner(T, shown, rim) for shown in (both.front_shown, both.back_shown)]
    turning = _inner(T, both.front_shown, ~rim) & _inner(T, both.back_shown, ~rim)
    loose = np.clip((both.front - both.back - _THICK_MM[0]) / (_THICK_MM[1] - _THICK_MM[0]), 0, 1)
    share = loose * (free[0] | free[1]) / np.maximum(free[0].astype(float) + free[1], 1.0)
    W, rows = _means(X, np.vstack([T, behind[T]]), np.flatnonzero(np.r_[free[0] | turning, free[1]]))
    area = _areas(P, T)
    for _ in range(_ROUNDS):
        before = X[:n, :2].copy()
        for step in (_SHRINK, _SWELL):
            way = np.zeros_like(X)
            way[rows] = step * (W @ X - X[rows])
            X[:, 2] += way[:, 2]
            moved = X[:n, :2] + share[:, None] * (way[:n, :2] * free[0][:, None] + way[n:, :2] * free[1][:, None])
            X[:n, :2] = X[n:, :2] = moved
        turned = np.zeros(n, bool)
        turned[T[_areas(X[:n, :2], T) < _FLATTENED * area]] = True
        X[:n, :2] = X[n:, :2] = np.where(turned[:, None], before, X[:n, :2])
    return _clear(both, X[:n, :2], X[:n, 2], X[behind, 2], rasters)


def _inner(T: Integers, shown: Mask, without: Mask) -> Mask:
    """Vertices (n,) all of whose triangles are shown, but for some."""
    n = len(without)
    return _touched(T[shown], n) & ~_touched(T[~shown], n) & ~without


def _means(X: Floats, faces: Integers, rows: Integers) -> tuple[sp.csr_array, Integers]:
    """Matrix that takes each of these rows to the mean of its neighbours, the nearer the more."""
    a, b = edges_of(faces)[0].T
    weight = 1 / (((X[a] - X[b]) ** 2).sum(1) + _FLOOR_MM2)
    W = sp.csr_array((np.r_[weight, weight], (np.r_[a, b], np.r_[b, a])), (len(X), len(X)))[rows]
    return sp.diags_array(1 / np.asarray(W.sum(1)).ravel()) @ W, rows


def _areas(P: Floats, T: Integers) -> Floats:
    """Twice the areas in the plane."""
    u, v = P[T[:, 1]] - P[T[:, 0]], P[T[:, 2]] - P[T[:, 0]]
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _clear(both: Sheets, P: Floats, front: Floats, back: Floats, rasters: SheetRasters) -> Sheets:
    """The sheets at new places, clear of the head, and as far apart as they were where one only lines the other."""
    gap = both.front - both.back
    maps = rasters.at(P)
    inner = [_inner(both.triangles, shown, gap <= 0) for shown in (both.front_shown, both.back_shown)]
    front = np.where(inner[0], np.maximum(front, maps.front_floor + _CLEAR_MM), front)
    back = np.where(inner[1], np.minimum(back, maps.back_floor - _CLEAR_MM), back)
    front_seen, back_seen = (_touched(both.triangles[rows], len(P)) for rows in (both.front_shown, both.back_shown))
    front = np.where(front_seen, front, np.minimum(front, back + gap))
    back = np.where(back_seen, back, np.maximum(back, front - gap))
    back = np.minimum(back, front - np.minimum(gap, _APART_MM))
    return replace(both, points=P, front=front, back=back)


def _touched(T: Integers, n: int) -> Mask:
    touched = np.zeros(n, bool)
    touched[T] = True
    return touched
