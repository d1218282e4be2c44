"""Depths of the shell's two sheets over one set of triangles."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toongeo.arrays import Integers, Mask
from toongeo.pipeline.hair.shell.edges import boundary_edges
from toongeo.pipeline.hair.shell.harmonic import smooth_max, solved
from toongeo.pipeline.hair.shell.regions import HeadRaster
from toongeo.pipeline.hair.shell.sheet_rasters import SheetMaps, SheetRasters

__all__ = ["Sheets", "sheets"]

Floats = NDArray[np.floating]

_LIP_MM = 1.0  # between skin and the edge of hair that lies on it
_BALL, _PUFF = 0.95, 0.5  # fullness of the whole outline, and of a strand, against a sphere's
_SOFT_MM = 5.0  # over which one surface goes over into another
_SLOPE = 0.5  # by which hair gets thicker away from its line on the skin
_RISE = 1.5  # slope, at most, of hair away from where it comes from behind the head
_FULL = (0.5, 1.2)  # of the back against a sphere
_SHEET_MM = (0.8, 6.0)  # thickness of hair where only one side of it is seen: at the edge, and away from it
_FOLD_MM, _FOLD_WITHIN_MM = 4.5, 2.6  # fall of the edge of a fringe: steep, or it would cover more of the skin
_ROUNDS = 30  # passes that smooth the depth of the rim


@dataclass(frozen=True, eq=False)
class Sheets:
    """Two depths over one set of triangles, equal on the rim and front > back elsewhere.

    Attributes
    ----------
    points : (n, 2) float64, mm
    triangles : (m, 3) int64
    front, back : (n,) float64, mm
    front_shown, back_shown : (m,) bool
        Triangles where a sheet is seen; elsewhere it hides under the skin or lines the other sheet.
    """

    points: Floats
    triangles: Integers
    front: Floats
    back: Floats
    front_shown: Mask
    back_shown: Mask


@dataclass(frozen=True, eq=False)
class _Sheet:
    """One sheet's triangles and the vertices (n,) on their border, on the rim, and used at all."""

    triangles: Integers
    border: Mask
    used: Mask


def sheets(P: Floats, T: Integers, rasters: SheetRasters) -> Sheets:
    """Depths of the hair's front and back over triangles of the plane."""
    shown = rasters.shown(P[T].mean(1))
    rim = np.zeros(len(P), bool)
    edges = boundary_edges(T)
    rim[edges] = True
    front, back = (_sheet(T[rows], len(P)) for rows in shown)
    head, maps = rasters.head, rasters.at(P)
    joined = rim & front.border & back.border
    depth = _rim_depth(maps, head, edges, rim, joined, front, back)
    z_front = _front(P, T, front, rasters, maps, joined, depth)
    z_back = _back(P, back, rasters, maps, rim, depth)
    hem = rim & ~front.used & maps.hanging  # the lower edge of hair that hangs free
    rim_z = np.where(hem, z_back, depth)
    apart = _distance(P, rim)
    sheet = np.minimum(_SHEET_MM[0] + _SLOPE * apart, _SHEET_MM[1])
    z_back = np.where(back.used, z_back, z_front - sheet)
    hidden = np.minimum(z_back + sheet, np.maximum(maps.under, z_back + 0.5))
    z_front = np.where(front.used, z_front, np.maximum(hidden, _lip(P, z_front, front, maps)))
    z_back = np.minimum(z_back, z_front - np.minimum(0.4 + 0.3 * apart, 2.0))
    return Sheets(P, T, np.where(rim, rim_z, z_front), np.where(rim, rim_z, z_back), *shown)


def _lip(P: Floats, z: Floats, front: _Sheet, maps: SheetMaps) -> Floats:
    """Depth (n,) of the first row beside the hairline, where the shell folds under the skin; -inf farther off.

    From there it falls to the back of the head: one fall all the way would be so large that it alone shaded the line.
    """
    line = np.flatnonzero(front.border)
    away, nearest = cKDTree(P[line]).query(P)
    folded = np.minimum(z[line][nearest] - _FOLD_MM, np.where(maps.on_head, maps.under, np.inf))
    return np.where(away < _FOLD_WITHIN_MM, folded, -np.inf)


def _sheet(T: Integers, n: int) -> _Sheet:
    border, used = np.zeros(n, bool), np.zeros(n, bool)
    border[boundary_edges(T)] = True
    used[T] = True
    return _Sheet(T, border, used)


def _rim_depth(
    maps: SheetMaps, head: HeadRaster, edges: Integers, rim: Mask, joined: Mask, front: _Sheet, back: _Sheet
) -> Floats:
    """Depth (n,) of the rim, and of the hairline: on the skin where there is some, else where the crown turns."""
    n = len(rim)
    depth = np.full(n, head.rim_z)
    skin = front.border & maps.on_head & ~joined
    floor = np.full(n, -np.inf)
    ceiling = np.full(n, np.inf)
    depth[skin] = maps.on_skin[skin] + _LIP_MM
    floor[skin] = maps.on_skin[skin] - 0.5
    nape = rim & ~front.used
    depth[nape] = maps.behind_skin[nape] + 1.0
    ceiling[nape] = depth[nape] + 2.0
    return _smoothed(_smoothed(depth, edges, floor, ceiling), boundary_edges(front.triangles), floor, ceiling)


def _smoothed(values: Floats, edges: Integers, floor: Floats, ceiling: Floats) -> Floats:
    """Values smoothed along lines of edges, between bounds."""
    rows = np.unique(edges)
    ends = np.searchsorted(rows, edges)
    degree = np.bincount(ends.ravel(), minlength=len(rows))
    x, low, high = values[rows], floor[rows], ceiling[rows]
    for _ in range(_ROUNDS):
        total = np.bincount(ends[:, 0], x[ends[:, 1]], len(rows)) + np.bincount(ends[:, 1], x[ends[:, 0]], len(rows))
        x = np.clip(0.5 * x + 0.5 * total / degree, low, high)
    smooth = values.copy()
    smooth[rows] = x
    return smooth


def _front(
    P: Floats, T: Integers, front: _Sheet, rasters: SheetRasters, maps: SheetMaps, joined: Mask, depth: Floats
) -> Floats:
    """The larger of a ball within the whole outline, drawn to the hairline, and of hair of a thickness on the skin."""
    n, head = len(P), rasters.head
    whole = solved(P, T, joined, np.zeros((n, 1)), np.array([4.0]))[:, 0]
    ball = head.rim_z + _BALL * np.sqrt(np.maximum(whole, 0))
    line = front.border
    values = np.column_stack([np.where(line, depth, 0), np.zeros(n), np.where(line, depth - ball, 0)])
    base, bulge, pull = solved(P, front.triangles, line | ~front.used, values, np.array([0.0, 4.0, 0.0])).T
    root = np.sqrt(np.maximum(bulge, 0))
    width = np.minimum(_SOFT_MM, root)
    z = smooth_max(base + _PUFF * root, ball + pull, width)
    beside = front.border & ~joined & ~maps.on_head  # hair that comes from behind the neck or the far cheek
    if beside.any():
        far, nearest = cKDTree(P[beside]).query(P)
        z = np.minimum(z, depth[beside][nearest] + _RISE * far)
    away = _distance(P, front.border & ~joined)
    thick = _LIP_MM + np.minimum(_SLOPE * away, rasters.thickness)
    return np.where(line, depth, smooth_max(z, maps.front_floor + thick, width))


def _back(P: Floats, back: _Sheet, rasters: SheetRasters, maps: SheetMaps, rim: Mask, depth: Floats) -> Floats:
    """The smaller of a membrane that is as full as the skull asks for, and of hair of a thickness behind the skin."""
    n, head = len(P), rasters.head
    free = back.border & ~rim
    hem = rim & maps.hanging & (np.abs(depth - maps.behind_skin - 1.0) < 2.5)
    known = (back.border & ~hem) | ~back.used
    values = np.column_stack([np.where(back.border, depth, 0), np.zeros(n)])
    values[free, 0] = maps.behind_skin[free] + 1.0
    base, bulge = solved(P, back.triangles, known, values, np.array([0.0, 4.0])).T
    root = np.sqrt(np.maximum(bulge, 0))
    wanted = head.rim_z - head.back_z + rasters.thickness
    fullness = float(np.clip(wanted / max(root.max(), 1e-6), *_FULL))
    width = np.minimum(_SOFT_MM, root)
    away = _distance(P, rim & ~hem)
    thick = 0.5 + np.minimum(0.4 * away, rasters.thickness)
    z = -smooth_max(fullness * root - base, thick - maps.back_floor, width)
    return np.where(known, values[:, 0], z)


def _distance(P: Floats, marked: Mask) -> Floats:
    """mm (n,) to the nearest marked point."""
    return cKDTree(P[marked]).query(P)[0] if marked.any() else np.full(len(P), 1e3)
