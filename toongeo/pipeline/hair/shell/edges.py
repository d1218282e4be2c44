"""Edges of triangles in the plane: which bound them, and how to halve some."""

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Integers

__all__ = ["boundary_edges", "edges_of", "halved"]

Floats = NDArray[np.floating]


def edges_of(T: Integers) -> tuple[Integers, Integers, Integers]:
    """Edges (e, 2) once each, their number (m, 3) at each triangle (edge k runs from corner k to k + 1), and in how
    many triangles each is (e,)."""
    ends = np.sort(np.stack([T[:, [0, 1]], T[:, [1, 2]], T[:, [2, 0]]], 1), 2)
    code = ends[..., 0] * (T.max(initial=0) + 1) + ends[..., 1]
    _, first, number, count = np.unique(code, return_index=True, return_inverse=True, return_counts=True)
    return ends.reshape(-1, 2)[first], number.reshape(-1, 3), count


def boundary_edges(T: Integers) -> Integers:
    """Edges (b, 2) that only one triangle has."""
    edges, _, count = edges_of(T)
    return edges[count == 1]


def halved(P: Floats, T: Integers, split: NDArray[np.bool_]) -> tuple[Floats, Integers]:
    """Points and triangles with a new point in the middle of some edges (of ``edges_of``)."""
    edges, number, _ = edges_of(T)
    middle = np.where(split, len(P) + np.cumsum(split) - 1, -1)
    P = np.vstack([P, P[edges[split]].mean(1)])
    at = middle[number]
    halves = (at >= 0).sum(1)
    parts = [T[halves == 0]]
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        one = (halves == 1) & (at[:, k] >= 0)
        parts += [_triangles(T[one, k], at[one, k], T[one, j]), _triangles(at[one, k], T[one, i], T[one, j])]
        two = (halves == 2) & (at[:, k] < 0)
        a, b = at[two, i], at[two, j]
        parts += [_triangles(T[two, j], b, a), _triangles(T[two, k], T[two, i], a), _triangles(T[two, k], a, b)]
    three = halves == 3
    t, m = T[three].T, at[three].T
    parts += [_triangles(t[0], m[0], m[2]), _triangles(m[0], t[1], m[1]), _triangles(m[2], m[1], t[2]), at[three]]
    return P, np.vstack(parts)


def _triangles(*corners: Integers) -> Integers:
    return np.column_stack(corners)
