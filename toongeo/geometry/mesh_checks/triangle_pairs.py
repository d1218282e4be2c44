"""Do two triangles intersect? Vectorised over pairs: the narrow phase of `self_intersections`.

Triangles are arrays (3 coordinates, 3 corners, p): with the pairs last, all sums and minima run over
contiguous memory.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.operators.cross import cross

__all__ = ["triangles_intersect"]

# Below this fraction of (largest edge)^2 x (size of the mesh) a signed volume counts as zero.
_ZERO = 1e-14


def triangles_intersect(
    T: NDArray[np.float64], corners: NDArray[np.int64], i: NDArray[np.int64], j: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Mask (p,) of the pairs of triangles with at most one common vertex that intersect elsewhere.

    `T` (3, 3, m) are the triangles in units of the mesh's size, around its centre, `corners` (3, m) their
    vertices. Contact counts.
    """
    result = np.zeros(len(i), dtype=bool)
    normals, sizes = _normal(T), _squared_size(T)
    alive = np.flatnonzero((corners[:, i][:, None] == corners[:, j][None]).sum(axis=(0, 1)) <= 1)

    # One after the other: most pairs are apart already in the plane of the one.
    for a, b in ((i, j), (j, i)):
        common = (corners[:, a[alive]][:, None] == corners[:, b[alive]][None]).any(axis=1)
        sides = _sides(T[:, :, a[alive]], T[:, 0, b[alive]], normals[:, b[alive]], sizes[b[alive]], common)
        alive = alive[_reaches(sides, common)]
    i, j = i[alive], j[alive]

    same = corners[:, i][:, None] == corners[:, j][None]
    common_i, common_j = same.any(axis=1), same.any(axis=0)  # (3, p): which corner is shared
    Ti, Tj = T[:, :, i], T[:, :, j]
    si = _sides(Ti, Tj[:, 0], normals[:, j], sizes[j], common_i)  # corners of i against the plane of j
    sj = _sides(Tj, Ti[:, 0], normals[:, i], sizes[i], common_j)
    size = np.maximum(sizes[i], sizes[j])
    hit = _edges_hit(Ti, Tj, si, size, common_i) | _edges_hit(Tj, Ti, sj, size, common_j)
    flat = (si == 0).all(axis=0) & (sj == 0).all(axis=0)
    hit[flat] = _overlap_in_plane(Ti[:, :, flat], Tj[:, :, flat])
    result[alive[hit]] = True
    return result


def _dot(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return (a * b).sum(axis=0)


def _normal(T: NDArray[np.float64]) -> NDArray[np.float64]:
    return cross(T[:, 1] - T[:, 0], T[:, 2] - T[:, 0])


def _squared_size(T: NDArray[np.float64]) -> NDArray[np.float64]:
    edges = T - np.roll(T, 1, axis=1)
    return _dot(edges, edges).max(axis=0)


def _snap(volumes: NDArray[np.float64], size: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where(np.abs(volumes) <= _ZERO * size, 0.0, volumes)


def _sides(
    T: NDArray[np.float64],
    corner: NDArray[np.float64],
    normal: NDArray[np.float64],
    size: NDArray[np.float64],
    common: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Signed volumes (3, p) of the corners of T over triangles of a corner and a normal (3, p); 0 for common ones."""
    volumes = _dot(T - corner[:, None], normal[:, None])
    return np.where(common, 0.0, _snap(volumes, size))


def _reaches(sides: NDArray[np.float64], common: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether a triangle meets the other's plane somewhere else than in a common corner."""
    below, above = np.where(common, np.inf, sides).min(axis=0), np.where(common, -np.inf, sides).max(axis=0)
    return (below <= 0) & (above >= 0)


def _edges_hit(
    T: NDArray[np.float64],
    other: NDArray[np.float64],
    sides: NDArray[np.float64],
    size: NDArray[np.float64],
    common: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """Whether an edge of T passes through `other`. With a common corner only the opposite edge can."""
    hit = np.zeros(T.shape[2], dtype=bool)
    alone = ~common.any(axis=0)
    for k in range(3):
        p, q = (k + 1) % 3, (k + 2) % 3
        crossing = (sides[p] * sides[q] <= 0) & (sides[p] != sides[q])
        at = np.flatnonzero(crossing & (alone | common[k]) & ~hit)
        start = T[:, p, at]
        direction = T[:, q, at] - start
        seen = other[:, :, at] - start[:, None]
        # Volumes the segment spans with the three edges: one sign if it passes within.
        turns = _snap(_dot(cross(seen, np.roll(seen, -1, axis=1)), direction[:, None]), size[at])
        inside = (turns >= 0).all(axis=0) | (turns <= 0).all(axis=0)
        hit[at] = inside & (turns != 0).any(axis=0)  # all zero: a triangle without area
    return hit


def _overlap_in_plane(A: NDArray[np.float64], B: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether coplanar triangles share an area: no edge of either has the other on its outer side."""
    size = np.maximum(_squared_size(A), _squared_size(B))
    overlap = np.ones(A.shape[2], dtype=bool)
    for T, U in ((A, B), (B, A)):
        up = _normal(T)
        slack = 1e-12 * size * np.sqrt(_dot(up, up))
        for k in range(3):
            inward = cross(up, T[:, (k + 1) % 3] - T[:, k])
            overlap &= _dot(U - T[:, k : k + 1], inward[:, None]).max(axis=0) > slack
    return overlap
