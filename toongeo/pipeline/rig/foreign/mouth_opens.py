"""Whether a head has two lips."""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from toongeo.arrays import Floats, Integers
from toongeo.geometry.operators.adjacency import adjacency

__all__ = ["mouth_opens"]

_UPPER, _UPPER_INNER, _LOWER_INNER, _LOWER = 51, 62, 66, 57
# Of the way over the lips along their landmarks: the way on the surface is about as long where it goes over the line
# between them, and 2.7 times as long around a corner of the mouth of the template. Edges are a detour of some tenths.
_FUSED = 1.7


def mouth_opens(V: Floats, F: Integers, points: Floats) -> bool | None:
    """Whether the surface is cut between the lips; None if landmarks of their middle are missing.

    Parameters
    ----------
    V : (n, 3) float64
    F : (m, 3) int64
    points : (68, 3) float64
        iBUG-68; NaN rows are missing.
    """
    way = points[[_UPPER, _UPPER_INNER, _LOWER_INNER, _LOWER]]
    if not np.isfinite(way).all():
        return None
    straight = float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
    near = np.unique(F[(np.linalg.norm(V - way.mean(0), axis=1) < 3 * straight)[F].all(1)])
    if len(near) == 0:
        return None
    graph = adjacency(F, len(V))[near][:, near].tocoo()
    graph.data = np.linalg.norm(V[near[graph.row]] - V[near[graph.col]], axis=1)
    upper, lower = cKDTree(V[near]).query(way[[0, 3]])[1]
    along = float(dijkstra(graph.tocsr(), directed=False, indices=upper, limit=2 * _FUSED * straight)[lower])
    return along > _FUSED * straight
