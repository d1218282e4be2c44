"""Closest points of a mesh among those that face the same way."""

from __future__ import annotations

import igl
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toongeo.arrays import Floats, Integers
from toongeo.geometry.operators.vertex_normals import vertex_normals

__all__ = ["FacingSurface", "barycentric"]

_NEAREST = 2  # vertices whose triangles are candidates, besides the closest triangle of all
_AROUND = 8  # triangles considered of each; a vertex with more is rare and has small ones
_NORMAL_REACH = 0.08  # of the mesh's size: how much distance a reversed normal outweighs, in the choice of candidates
FACING = 0.5  # least cosine between the normals of a point and of its partner
_ON_EDGE = 1e-6  # a barycentric coordinate below this lies on the opposite edge


class FacingSurface:
    """A mesh prepared for many searches: closest point, but on a side that looks where the seeker looks.

    Without the normals, an upper lip finds the lower one and the front of an ear finds its back.
    """

    def __init__(self, V: Floats, F: Integers) -> None:
        self.V, self.F = V, F
        corners = V[F]
        self.triangle_normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        length = np.linalg.norm(self.triangle_normals, axis=1, keepdims=True)
        self.triangle_normals /= np.where(length > 0, length, 1.0)
        self.normals = vertex_normals(V, F)
        used = np.unique(F)
        self.reach = _NORMAL_REACH * float(np.linalg.norm(np.ptp(V[used], axis=0)))
        self._used = used
        self._tree = cKDTree(np.hstack([V[used], self.reach * self.normals[used]]))
        self._around = _triangles_around(F, len(V))
        self._open = _open_sides(F)

    def closest(self, P: Floats, N: Floats) -> tuple[Integers, Floats, Floats]:
        """Triangle (p,), barycentric coordinates (p, 3) and cosine (p,) of the best partner of points with normals.

        A partner that faces the same way comes first, the nearest of them; where there is none, the nearest of all.
        """
        triangles = igl.point_mesh_squared_distance(P, self.V, self.F)[1].astype(np.int64)
        bary = barycentric(P, self.V[self.F[triangles]])
        cosines = np.asarray((self.normals_at(triangles, bary) * N).sum(1))
        away = np.flatnonzero(cosines < FACING)
        if len(away):
            found = self._facing(P[away], N[away])
            better = found[2] >= FACING
            for values, new in zip((triangles, bary, cosines), found, strict=True):
                values[away[better]] = new[better]
        return triangles, bary, cosines

    def _facing(self, P: Floats, N: Floats) -> tuple[Integers, Floats, Floats]:
        """As `closest`, by position and normal together: this proposes vertices, then true distances decide."""
        near = self._tree.query(np.hstack([P, self.reach * N]), _NEAREST)[1].reshape(len(P), -1)
        candidates = self._around[self._used[near]].reshape(len(P), -1)
        rows, columns = np.nonzero(candidates >= 0)
        triangles = candidates[rows, columns]
        bary = np.zeros((*candidates.shape, 3))
        bary[rows, columns] = barycentric(P[rows], self.V[self.F[triangles]])
        squares = np.full(candidates.shape, np.inf)
        cosines = np.full(candidates.shape, -1.0)
        squares[rows, columns] = ((self.points(triangles, bary[rows, columns]) - P[rows]) ** 2).sum(1)
        cosines[rows, columns] = (self.normals_at(triangles, bary[rows, columns]) * N[rows]).sum(1)
        best = np.where(cosines >= FACING, squares, np.inf).argmin(1)
        every = np.arange(len(P))
        return candidates[every, best], bary[every, best], cosines[every, best]

    def points(self, triangles: Integers, bary: Floats) -> Floats:
        """Points (p, 3) at barycentric coordinates."""
        return np.asarray(np.einsum("pc,pcd->pd", bary, self.V[self.F[triangles]]))

    def normals_at(self, triangles: Integers, bary: Floats) -> Floats:
        """Unit normals (p, 3), interpolated between the vertices."""
        normals = np.einsum("pc,pcd->pd", bary, self.normals[self.F[triangles]])
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        return np.asarray(
            np.where(length > 0, normals / np.where(length > 0, length, 1.0), self.triangle_normals[triangles])
        )

    def at_border(self, triangles: Integers, bary: Floats) -> NDArray[np.bool_]:
        """Whether points (p,) lie on an edge where the mesh ends: what seeks them lies beyond it, mostly."""
        return np.asarray(((bary <= _ON_EDGE) & self._open[triangles]).any(1))


def _triangles_around(F: Integers, n: int) -> Integers:
    """Up to _AROUND triangles (n, _AROUND) at every vertex, filled up with -1."""
    corner = F.ravel()
    order = np.argsort(corner, kind="stable")
    start = np.searchsorted(corner[order], np.arange(n))
    rank = np.arange(len(order)) - start[corner[order]]
    around = np.full((n, _AROUND), -1)
    kept = rank < _AROUND
    around[corner[order][kept], rank[kept]] = order[kept] // 3
    return around


def _open_sides(F: Integers) -> NDArray[np.bool_]:
    """(m, 3): whether the edge opposite to each corner belongs to one triangle only."""
    n = int(F.max()) + 1
    a, b = np.roll(F, -1, axis=1), np.roll(F, -2, axis=1)
    key = np.minimum(a, b) * n + np.maximum(a, b)
    _, inverse, count = np.unique(key, return_inverse=True, return_counts=True)
    return np.asarray(count[inverse].reshape(F.shape) == 1)


def barycentric(P: Floats, triangles: Floats) -> Floats:
    """Barycentric coordinates (p, 3) of the points of triangles (p, 3, 3) closest to points (p, 3)."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    ab, ac, ap = b - a, c - a, P - a
    g11, g12, g22 = (ab * ab).sum(1), (ab * ac).sum(1), (ac * ac).sum(1)
    r1, r2 = (ab * ap).sum(1), (ac * ap).sum(1)
    determinant = g11 * g22 - g12 * g12
    flat = determinant <= 1e-14 * g11 * g22
    safe = np.where(flat, 1.0, determinant)
    v, w = (g22 * r1 - g12 * r2) / safe, (g11 * r2 - g12 * r1) / safe
    inside = (v >= 0) & (w >= 0) & (v + w <= 1) & ~flat
    bary = np.stack([1 - v - w, v, w], axis=1)
    out = np.flatnonzero(~inside)
    if len(out):  # the closest point lies on one of the three edges
        bary[out] = _on_edges(P[out], triangles[out])
    return bary


def _on_edges(P: Floats, triangles: Floats) -> Floats:
    best, least = np.zeros((len(P), 3)), np.full(len(P), np.inf)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        a, edge = triangles[:, i], triangles[:, j] - triangles[:, i]
        length = (edge * edge).sum(1)
        t = np.clip(((P - a) * edge).sum(1) / np.where(length > 0, length, 1.0), 0, 1)
        square = ((a + t[:, None] * edge - P) ** 2).sum(1)
        nearer = square < least
        least[nearer] = square[nearer]
        found = np.zeros((len(P), 3))
        found[:, i], found[:, j] = 1 - t, t
        best[nearer] = found[nearer]
    return best
