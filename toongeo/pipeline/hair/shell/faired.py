"""The shell smoothed as a surface in space."""

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from toongeo.pipeline.hair.shell.edges import boundary_edges, edges_of
from toongeo.pipeline.hair.shell.sheet_rasters import SheetRasters
from toongeo.pipeline.hair.shell.sheets import Sheets

__all__ = ["faired"]

Floats = NDArray[np.floating]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

_ROUNDS, _SHRINK, _SWELL = 20, 0.5, -0.51  # of Taubin 1995: a round keeps what is broad as large as it was
_FLOOR_MM2 = 1.0  # added to squared lengths of edges, so that none counts for all
_THICK_MM = (4.0, 12.0)  # of a shell whose points may leave their place in the plane: thin strands keep it
_FLATTENED = 0.2  # of a triangle's area in the plane is left at least
_CLEAR_MM = 1.0  # of hair over what the skin reaches


def faired(both: Sheets, rasters: SheetRasters) -> tuple[Floats, Floats]:
    """Points (n, 3) of the front and of the back whose walls no longer repeat every notch of the outline.

    The rim moves in depth only, which keeps the silhouette; lines on the skin and what is hidden stay. No triangle
    turns over in the plane, so that each sheet remains one over it.
    """
    P, T = both.points, both.triangles
    n = len(P)
    rim = np.zeros(n, bool)
    rim[boundary_edges(T)] = True
    behind = np.where(rim, np.arange(n), n + np.arange(n))
    X = np.vstack([np.column_stack([P, both.front]), np.column_stack([P, both.back])])
    free_front, free_back = (_inner(T, shown, rim) for shown in (both.front_shown, both.back_shown))
    turning = rim & _inner(T, both.front_shown, ~rim) & _inner(T, both.back_shown, ~rim)
    free = np.r_[free_front | turning, free_back]
    loose = np.clip((both.front - both.back - _THICK_MM[0]) / (_THICK_MM[1] - _THICK_MM[0]), 0, 1) * ~rim
    ways = np.column_stack([np.tile(loose, 2), np.tile(loose, 2), np.ones(2 * n)])
    faces = np.vstack([T, behind[T]])
    W, rows = _means(X, faces, np.flatnonzero(free))
    area = _areas(X, faces)
    for _ in range(_ROUNDS):
        before = X[rows].copy()
        for step in (_SHRINK, _SWELL):
            X[rows] += step * (W @ X - X[rows]) * ways[rows]
        turned = np.zeros(2 * n, bool)
        turned[faces[_areas(X, faces) < _FLATTENED * area]] = True
        X[rows] = np.where(turned[rows, None], before, X[rows])
    return _clear(X[:n], X[behind], both, rasters)


def _inner(T: Ints, shown: Mask, without: Mask) -> Mask:
    """Vertices (n,) all of whose triangles are shown, but for some."""
    inner = np.zeros(len(without), bool)
    inner[T[shown]] = True
    inner[T[~shown]] = False
    return inner & ~without


def _means(X: Floats, faces: Ints, rows: Ints) -> tuple[sp.csr_array, Ints]:
    """Matrix that takes each of these rows to the mean of its neighbours, the nearer the more."""
    a, b = edges_of(faces)[0].T
    weight = 1 / (((X[a] - X[b]) ** 2).sum(1) + _FLOOR_MM2)
    W = sp.csr_array((np.r_[weight, weight], (np.r_[a, b], np.r_[b, a])), (len(X), len(X)))[rows]
    return sp.diags_array(1 / np.asarray(W.sum(1)).ravel()) @ W, rows


def _areas(X: Floats, faces: Ints) -> Floats:
    """Twice the areas in the plane."""
    u, v = X[faces[:, 1], :2] - X[faces[:, 0], :2], X[faces[:, 2], :2] - X[faces[:, 0], :2]
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _clear(front: Floats, back: Floats, both: Sheets, rasters: SheetRasters) -> tuple[Floats, Floats]:
    """Both sheets clear of the head, and of each other as before."""
    gap = both.front - both.back
    n = len(gap)
    for X, shown, side in ((front, both.front_shown, 1), (back, both.back_shown, -1)):
        inner = _inner(both.triangles, shown, gap <= 0)
        maps = rasters.at(X[:, :2])
        floor = maps.front_floor + _CLEAR_MM if side > 0 else maps.back_floor - _CLEAR_MM
        X[:, 2] = np.where(inner, side * np.maximum(side * X[:, 2], side * floor), X[:, 2])
    seen = [np.zeros(n, bool), np.zeros(n, bool)]
    for mask, shown in zip(seen, (both.front_shown, both.back_shown), strict=True):
        mask[both.triangles[shown]] = True
    # What lines the other sheet follows it.
    front[~seen[0], 2] = np.minimum(front[~seen[0], 2], (back[:, 2] + gap)[~seen[0]])
    back[~seen[1], 2] = np.maximum(back[~seen[1], 2], (front[:, 2] - gap)[~seen[1]])
    back[:, 2] = np.minimum(back[:, 2], front[:, 2] - np.minimum(gap, 1.5))
    return front, back
