"""A dense mesh with fewer vertices, for work that need not see them all."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats, Integers, Mask
from toongeo.geometry.operators.adjacency import adjacency
from toongeo.geometry.operators.vertex_components import vertex_components

__all__ = ["thinned_mesh"]

_SMALL = 500  # vertices: parts of a mesh with fewer (a tooth, a lash) keep them all


def thinned_mesh(V: Floats, F: Integers, most: int) -> tuple[Integers, Integers]:
    """Some vertices of a mesh, evenly spread, and triangles between them.

    A vertex is kept if none beside it is (a maximal independent set); every other one is taken for the nearest kept
    one beside it. So nothing is joined that the surface does not join: lips that touch stay apart.

    Parameters
    ----------
    V : (n, 3) float64
    F : (m, 3) int64
        A checked mesh.
    most : int
        Vertices of the result, about; a mesh that has no more comes back as it is.

    Returns
    -------
    kept : (c,) int64
        Ascending indices into ``V``.
    faces : (k, 3) int64
        Triangles of the kept vertices, counted among them, wound as those of ``F``.

    Examples
    --------
    >>> kept, faces = thinned_mesh(np.eye(3), np.array([[0, 1, 2]]), 3)
    >>> kept, faces
    (array([0, 1, 2]), array([[0, 1, 2]]))
    """
    kept = np.arange(len(V))
    while len(kept) > most:
        stays = _spread(F, len(kept))
        if stays.all():
            break
        label = _nearest_beside(V[kept], F, stays)
        F = _distinct(label[F])
        used = np.unique(F)
        kept, F = kept[used], np.searchsorted(used, F)
    return kept, F


def _spread(F: Integers, n: int) -> Mask:
    """A maximal independent set (n,) of the vertices, and all vertices of small parts (Luby 1986)."""
    part = vertex_components(F, n)
    stays = np.bincount(part)[part] < _SMALL
    graph = adjacency(F, n).tocoo()
    a, b = graph.row, graph.col
    rank = np.random.default_rng(0).permutation(n)  # the same for the same mesh
    undecided = ~stays
    while undecided.any():
        both = undecided[a] & undecided[b]
        lowest = np.full(n, n)
        np.minimum.at(lowest, a[both], rank[b[both]])
        chosen = undecided & (rank < lowest)
        stays |= chosen
        undecided &= ~chosen
        undecided[b[chosen[a]]] = False
    return stays


def _nearest_beside(V: Floats, F: Integers, stays: Mask) -> Integers:
    """For each vertex (n,) itself if it stays, else the nearest of those beside it that do."""
    graph = adjacency(F, len(V)).tocoo()
    found = ~stays[graph.row] & stays[graph.col]
    a, b = graph.row[found], graph.col[found]
    order = np.lexsort((b, ((V[a] - V[b]) ** 2).sum(1), a))
    first = np.unique(a[order], return_index=True)[1]
    label = np.arange(len(V))
    label[a[order[first]]] = b[order[first]]
    return label


def _distinct(F: Integers) -> Integers:
    """Triangles with three corners, each once."""
    F = F[(F[:, 0] != F[:, 1]) & (F[:, 1] != F[:, 2]) & (F[:, 2] != F[:, 0])]
    first = F.argmin(axis=1)
    turned = np.stack([F[np.arange(len(F)), (first + k) % 3] for k in range(3)], axis=1)
    return np.unique(turned, axis=0)
