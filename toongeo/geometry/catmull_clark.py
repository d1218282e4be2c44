"""Catmull-Clark subdivision of a quad mesh as one sparse matrix."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

__all__ = ["catmull_clark"]

_Entries = tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]  # rows, columns, values of a sparse matrix


def catmull_clark(quads: ArrayLike, n_vertices: int) -> tuple[sp.csr_matrix, NDArray[np.int64]]:
    """One Catmull-Clark step, as a matrix: the subdivision is linear in the vertex positions.

    The new vertices are ordered: the old vertices (moved), then one a edge (edges as pairs ``i < j``,
    sorted by ``(i, j)``), then one a quad. Anything linear in the vertices (positions, bases, colours)
    is subdivided by ``S @ X``.

    Inside the mesh the rules are those of Catmull and Clark: a quad point is the mean of its corners, an
    edge point the mean of its two ends and its two quad points, and an old vertex of valence ``k`` moves to
    ``(F + 2 R + (k - 3) P) / k``. The boundary is a cubic B-spline curve of its own vertices alone: edge
    points are midpoints, and old vertices take ``(1, 6, 1) / 8``. A vertex where more than two boundary
    edges meet, and a vertex without a quad, stay where they are.

    Parameters
    ----------
    quads : (q, 4) int
        Corner indices, counter-clockwise from outside, 0-based.
    n_vertices : int
        Number of vertices ``n0``; every index is below it.

    Returns
    -------
    S : (n1, n0) csr_matrix of float64
        Every row sums to one; ``n1 = n0 + edges + q``.
    quads1 : (4 q, 4) int64
        The children of quad ``k`` are rows ``4 k .. 4 k + 3``. Child ``c`` sits at corner ``c``:
        ``[corner, next edge point, quad centre, previous edge point]``, so the winding is kept.

    Raises
    ------
    ValueError
        If `quads` is not (q, 4) with q >= 1, an index is out of range, a quad uses a vertex twice, or an
        edge has more than two quads.

    References
    ----------
    E. Catmull, J. Clark, "Recursively generated B-spline surfaces on arbitrary topological meshes",
    Computer-Aided Design 10(6), 1978. Boundary rule: H. Biermann et al., SIGGRAPH 2000.

    Examples
    --------
    >>> import numpy as np
    >>> V = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    >>> S, quads1 = catmull_clark([[0, 1, 2, 3]], 4)
    >>> (S @ V)[8]
    array([0.5, 0.5])
    >>> quads1[0]
    array([0, 4, 8, 5])
    """
    quads = _checked_quads(quads, n_vertices)
    q = len(quads)
    edges, edge_of_side, sides_of_edge = _edges(quads, n_vertices)
    e = len(edges)

    blocks = [
        _vertex_rules(quads, edges, sides_of_edge, n_vertices),
        _edge_rules(quads, edges, edge_of_side, sides_of_edge, n_vertices),
        _entries(np.repeat(np.arange(q), 4) + (n_vertices + e), quads.ravel(), 0.25),
    ]
    rows, columns, values = _join(*blocks)
    S = sp.csr_matrix((values, (rows, columns)), shape=(n_vertices + e + q, n_vertices))

    following = n_vertices + edge_of_side  # side c runs from corner c to corner c + 1
    centre = np.broadcast_to((n_vertices + e + np.arange(q))[:, None], (q, 4))
    quads1 = np.stack([quads, following, centre, np.roll(following, 1, axis=1)], axis=2)
    return S, quads1.reshape(4 * q, 4)


def _checked_quads(quads: ArrayLike, n_vertices: int) -> NDArray[np.int64]:
    quads = np.asarray(quads)
    if quads.ndim != 2 or quads.shape[1] != 4 or len(quads) == 0 or quads.dtype.kind not in "iu":
        raise ValueError(
            f"quads: expected an integer array of shape (q, 4) with q >= 1, got {quads.dtype} {quads.shape}"
        )
    quads = quads.astype(np.int64)
    if quads.min() < 0 or quads.max() >= n_vertices:
        raise ValueError(f"quads: expected indices in 0..{n_vertices - 1}, got {quads.min()}..{quads.max()}")
    ordered = np.sort(quads, axis=1)
    repeats = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
    if repeats.any():
        raise ValueError(f"quads: expected four different corners, got a repeat in quad {repeats.argmax()}")
    return quads


def _edges(quads: NDArray[np.int64], n: int) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Sorted unique edges (e, 2), the edge of each quad side (q, 4), and how many quads an edge has."""
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2)
    key = ends.min(axis=2) * n + ends.max(axis=2)
    unique, inverse, count = np.unique(key, return_inverse=True, return_counts=True)
    if count.max() > 2:
        i, j = divmod(int(unique[count.argmax()]), n)
        raise ValueError(f"quads: expected at most two quads an edge, got {count.max()} at edge ({i}, {j})")
    return np.stack(np.divmod(unique, n), axis=1), inverse.reshape(quads.shape), count


def _entries(rows: NDArray[np.int64], columns: NDArray[np.int64], values: ArrayLike) -> _Entries:
    return rows, columns, np.broadcast_to(np.asarray(values, dtype=float), rows.shape)


def _join(*entries: _Entries) -> _Entries:
    rows, columns, values = (np.concatenate(part) for part in zip(*entries, strict=True))
    return rows, columns, values


def _edge_rules(
    quads: NDArray[np.int64],
    edges: NDArray[np.int64],
    edge_of_side: NDArray[np.int64],
    sides_of_edge: NDArray[np.int64],
    n: int,
) -> _Entries:
    inner = sides_of_edge == 2
    row = n + np.arange(len(edges))
    # Mean of two ends and two quad points: 1/4 an end, 1/16 a corner of each quad. Boundary: the midpoint.
    end = np.where(inner, 0.25, 0.5)
    side = edge_of_side.ravel()
    keep = inner[side]
    side_quads = np.repeat(quads, 4, axis=0)[keep]
    return _join(
        _entries(np.repeat(row, 2), edges.ravel(), np.repeat(end, 2)),
        _entries(np.repeat(row[side[keep]], 4), side_quads.ravel(), 1 / 16),
    )


def _vertex_rules(
    quads: NDArray[np.int64], edges: NDArray[np.int64], sides_of_edge: NDArray[np.int64], n: int
) -> _Entries:
    valence = np.bincount(quads.ravel(), minlength=n)
    rim = edges[sides_of_edge == 1]
    rim_count = np.bincount(rim.ravel(), minlength=n)
    inner = (rim_count == 0) & (valence > 0)
    smooth_rim = rim_count == 2
    k = np.maximum(valence, 1).astype(float)

    # (F + 2 R + (k - 3) P) / k with R the mean edge midpoint: P collects (k - 2) / k, each edge neighbour
    # 1 / k^2, each corner of each adjacent quad 1 / (4 k^2).
    own = np.where(inner, (k - 2) / k, np.where(smooth_rim, 0.75, 1.0))
    both = np.concatenate([edges, edges[:, ::-1]])
    both = both[inner[both[:, 0]]]
    corner = quads.ravel()
    keep = inner[corner]
    around = np.repeat(quads, 4, axis=0)[keep]
    rim_both = np.concatenate([rim, rim[:, ::-1]])
    rim_both = rim_both[smooth_rim[rim_both[:, 0]]]
    return _join(
        _entries(np.arange(n), np.arange(n), own),
        _entries(both[:, 0], both[:, 1], 1 / k[both[:, 0]] ** 2),
        _entries(np.repeat(corner[keep], 4), around.ravel(), np.repeat(0.25 / k[corner[keep]] ** 2, 4)),
        _entries(rim_both[:, 0], rim_both[:, 1], 1 / 8),
    )
