"""Triangles of a region of the plane, true to outlines of it and of its parts."""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import Delaunay, cKDTree
from skimage.measure import find_contours, points_in_poly

from toongeo.arrays import Integers, Mask, Reals
from toongeo.pipeline.hair.plane.masks import signed
from toongeo.pipeline.hair.plane.working_plane import CELL_MM, WorkingPlane

__all__ = ["planar_mesh"]


STEP_MM, GRID_MM = 2.8, 7.5  # spacing along outlines, and between the points inside
RINGS_MM = (1.5, 4.5)  # inside outlines: rows of points, without which a shell that turns there is a washboard
FOLD_MM = (-1.3, -4.5)  # outside a part: rows where the shell folds away from it
_CLOSE_MM = 1.6  # nearer to another outline an outline adds nothing
_SOFT, _EPSILON = 0.8, 0.35  # cells: what smooths an outline, and what may lie beside a chord before it gets a corner
_CALM_MM, _NOTCH_MM = 6.0, 1.2  # smooths the outer outline; notches beyond this stay, smaller ones furrow the sides
_SHORTEST_MM = 0.3  # pieces of outlines below this are not split any more
_PASSES = 8
_SMALLEST_MM2 = 30.0  # outlines that bound less are left out
_LARGE_MM2 = 1.0e5  # regions beyond this get larger triangles inside


@dataclass(frozen=True, eq=False)
class _Outlines:
    """Points (k, 2) on outlines, and the pieces (s, 2) between them."""

    points: Reals
    pieces: Integers


def planar_mesh(plane: WorkingPlane, whole: Mask, parts: Sequence[Mask]) -> tuple[Reals, Integers]:
    """Conforming Delaunay triangles of a region, along whose parts' outlines there are edges too.

    Parameters
    ----------
    plane : WorkingPlane
    whole : (rows, columns) bool
        Region; its outlines are kept to a fraction of a cell.
    parts : of (rows, columns) bool
        Within it.

    Returns
    -------
    P : (n, 2) float64
        Plane points, mm.
    T : (m, 3) int64
        Counter-clockwise.
    """
    rings = _outlines(plane, whole, _without_notches)
    outer = rings.copy()
    tree = cKDTree(np.vstack(rings))
    lines = [np.vstack([ring, ring[:1]]) for ring in rings]
    for part in parts:
        for ring in _outlines(plane, part):
            lines += _runs(ring, tree.query(ring)[0] > _CLOSE_MM)
            tree = cKDTree(np.vstack([tree.data, ring]))
    outline = _joined(lines)
    loose = _inner_points(plane, whole, parts, outline.points)
    P, T = _conforming(outline, loose)
    inside = _within(outer, P[T].mean(1))
    used, T = np.unique(T[inside], return_inverse=True)
    return P[used], T.reshape(-1, 3)


def _outlines(plane: WorkingPlane, mask: Mask, smoothed: Callable[[Reals], Reals] | None = None) -> list[Reals]:
    """Closed lines (k, 2), mm, about the pieces of a mask and their holes, in pieces no longer than the step."""
    soft = cv2.GaussianBlur(np.pad(mask.astype(np.float32), 2), (0, 0), _SOFT)
    lines = []
    for contour in find_contours(soft, 0.5):
        line = contour[:-1, ::-1] - 2
        if len(line) >= 8 and cv2.contourArea(line.astype(np.float32)) * CELL_MM**2 > _SMALLEST_MM2:
            lines.append(plane.points(_thinned(line if smoothed is None else smoothed(line))))
    return lines


def _without_notches(line: Reals) -> Reals:
    """A closed line, cells, without what is no more than noise of its pixels."""
    sigma = _CALM_MM / CELL_MM
    calm = gaussian_filter1d(line, sigma, axis=0, mode="wrap")
    calm = calm + gaussian_filter1d(line - calm, sigma, axis=0, mode="wrap")  # does not shrink what is round
    off = np.linalg.norm(calm - line, axis=1, keepdims=True) * CELL_MM / _NOTCH_MM
    return np.asarray(line + (calm - line) * np.clip(2 - off, 0, 1))


def _thinned(line: Reals) -> Reals:
    """Points of a closed line: its corners, and others between them at most a step apart."""
    corners = cv2.approxPolyDP(line[:, None].astype(np.float32), _EPSILON, True)[:, 0]
    at = np.sort(cKDTree(line).query(corners)[1])
    ends = np.r_[at, at[0] + len(line)]
    length = np.r_[0, np.cumsum(np.linalg.norm(np.roll(line, -1, 0) - line, axis=1))]
    length = np.r_[length, length[-1] + length[1:]]
    places = [
        np.linspace(a, b, max(1, int(np.ceil((b - a) * CELL_MM / STEP_MM))), endpoint=False)
        for a, b in itertools.pairwise(length[ends].tolist())
    ]
    twice = np.vstack([line, line, line[:1]])
    at_places = np.concatenate(places)
    return np.column_stack([np.interp(at_places, length, twice[:, k]) for k in range(2)])


def _runs(ring: Reals, kept: Mask) -> list[Reals]:
    """Open lines of consecutive kept points of a closed line; the whole, closed, if all are kept."""
    if kept.all():
        return [np.vstack([ring, ring[:1]])]
    start = int(np.flatnonzero(~kept)[0])
    ring, kept = np.roll(ring, -start, 0), np.roll(kept, -start)
    cuts = np.flatnonzero(np.diff(kept.astype(np.int8)))
    return [run for run in np.split(ring, cuts + 1)[1::2] if len(run) > 1]


def _joined(lines: list[Reals]) -> _Outlines:
    """All lines as one set of points; a closed line ends with its first point."""
    points, pieces, count = [], [], 0
    for line in lines:
        round_trip = bool((line[0] == line[-1]).all())
        k = len(line) - round_trip
        row = count + np.r_[np.arange(k), 0] if round_trip else count + np.arange(k)
        points.append(line[:k])
        pieces.append(np.column_stack([row[:-1], row[1:]]))
        count += k
    return _Outlines(np.vstack(points), np.vstack(pieces))


def _inner_points(plane: WorkingPlane, whole: Mask, parts: Sequence[Mask], taken: Reals) -> Reals:
    """Rows of points beside the outlines, and hexagons between."""
    rows: list[Reals] = []
    distances = [signed(mask) for mask in (whole, *parts)]
    for distance in distances:
        soft = cv2.GaussianBlur(distance, (0, 0), 1.5)
        for level in RINGS_MM if distance is distances[0] else (*RINGS_MM, *FOLD_MM):
            for contour in find_contours(soft, level):
                row = _even(plane.points(contour[:, ::-1]))
                row = row[plane.sample(distances[0], row) > 1.0]
                if len(row):
                    apart = min(0.45 * STEP_MM, 0.7 * abs(level))
                    row = row[cKDTree(np.vstack([taken, *rows])).query(row)[0] > apart]
                rows.append(row)
    coarse = GRID_MM * max(1.0, float(np.sqrt(whole.sum() * CELL_MM**2 / _LARGE_MM2)))
    low, high = plane.low, plane.points(np.array(plane.shape[::-1]))
    y = np.arange(low[1], high[1], coarse * np.sqrt(3) / 2)
    x = np.arange(low[0], high[0], coarse)
    shifted = x[None] + (np.arange(len(y)) % 2)[:, None] * coarse / 2
    grid = np.column_stack([shifted.ravel(), np.repeat(y, len(x))])
    grid = grid[plane.sample(distances[0], grid) > RINGS_MM[-1]]
    grid = grid[cKDTree(np.vstack([taken, *rows])).query(grid)[0] > 0.55 * coarse]
    return np.vstack([*rows, grid])


def _even(line: Reals) -> Reals:
    """Points of a line so many mm apart."""
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]
    at = np.arange(0, max(length[-1] - 0.5 * STEP_MM, 0.1), STEP_MM)
    return np.column_stack([np.interp(at, length, line[:, k]) for k in range(2)])


def _conforming(outline: _Outlines, loose: Reals) -> tuple[Reals, Integers]:
    """Delaunay triangles; pieces of the outlines are halved until each is an edge."""
    points, pieces = outline.points, outline.pieces
    for _ in range(_PASSES):
        P = np.vstack([points, loose])
        T = Delaunay(P).simplices.astype(np.int64)
        n = len(P)
        edges = np.sort(np.vstack([T[:, [0, 1]], T[:, [1, 2]], T[:, [2, 0]]]), 1)
        ends = np.sort(pieces, 1)
        missing = ~np.isin(ends[:, 0] * n + ends[:, 1], np.unique(edges[:, 0] * n + edges[:, 1]))
        missing &= np.linalg.norm(points[pieces[:, 0]] - points[pieces[:, 1]], axis=1) > _SHORTEST_MM
        if not missing.any():
            break
        a, b = pieces[missing].T
        middle = len(points) + np.arange(missing.sum())
        points = np.vstack([points, (points[a] + points[b]) / 2])
        pieces = np.vstack([pieces[~missing], np.column_stack([a, middle]), np.column_stack([middle, b])])
    P = np.vstack([points, loose])
    T = Delaunay(P).simplices.astype(np.int64)
    u, v = P[T[:, 1]] - P[T[:, 0]], P[T[:, 2]] - P[T[:, 0]]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    T = np.where(area[:, None] < 0, T[:, [0, 2, 1]], T)
    return P, T[np.abs(area) > 1e-6]


def _within(rings: list[Reals], points: Reals) -> Mask:
    """Points (k,) within closed lines (even-odd)."""
    return np.asarray(np.logical_xor.reduce([points_in_poly(points, ring) for ring in rings]))
