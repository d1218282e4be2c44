"""Vertices of a mesh that a file had to repeat."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats, Integers

__all__ = ["border_twins"]


def border_twins(V: Floats, F: Integers) -> Integers:
    """For each vertex the lowest-numbered one that it is a copy of: both at borders, in exactly one place.

    Files with one texture coordinate a vertex cut a surface along the seams of its texture, STL cuts out every
    triangle; ``twin[F]`` is the surface in one piece. Vertices inside a surface are no copies, wherever they lie: lips
    that touch stay apart if a mouth is behind them.

    Parameters
    ----------
    V : (n, 3) float64
    F : (m, 3) int64
        A checked mesh.

    Returns
    -------
    (n,) int64
        ``twin[twin] == twin``; a vertex without a copy is its own.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> border_twins(V, np.array([[0, 1, 2], [3, 4, 5]]))
    array([0, 1, 2, 1, 4, 2])
    """
    i, j = F.ravel(), np.roll(F, -1, axis=1).ravel()
    edge = np.minimum(i, j) * len(V) + np.maximum(i, j)
    _, at, count = np.unique(edge, return_inverse=True, return_counts=True)
    single = count[at] == 1
    border = np.unique(np.concatenate([i[single], j[single]]))
    places = V[border] + 0.0  # -0.0 and 0.0 are one place
    order = np.lexsort((border, *places.T))
    sorted_places = places[order]
    starts = np.ones(len(order), bool)
    starts[1:] = (sorted_places[1:] != sorted_places[:-1]).any(axis=1)
    twin = np.arange(len(V))
    twin[border[order]] = border[order[starts]][np.cumsum(starts) - 1]
    return twin
