"""Skin around crossings that moves as a whole.

Constants were chosen on bad_guy and beethoven (``benchmarks/crossings.py``).
"""

from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from toongeo.geometry import adjacency
from toongeo.model import MorphableModel

__all__ = ["affine_around"]

_RIDGE = 1e-3  # of the mean variance of the points: a flat patch tells nothing of what is across it


def affine_around(
    model: MorphableModel, start: np.ndarray, end: np.ndarray, vertices: np.ndarray, core: int, fade: int
) -> np.ndarray:
    """The end of a motion, made affine around vertices.

    An affine map takes no triangle through another: skin that was sound at the start stays so where it moves by one.
    Near lips and lids the neighbourhood of one vertex reaches over both sides of the slit, which then close as one
    piece of skin is pressed. Each connected neighbourhood has a map of its own, the nearest to its motion.

    Parameters
    ----------
    model : MorphableModel
    start, end : (n, 3) float64, mm
    vertices : (k,) int
        Of what crosses in ``end``.
    core, fade : int
        Edges around the vertices within which the motion becomes affine, and over which it then becomes its own again.

    Returns
    -------
    (n, 3) float64, mm
    """
    edges, face = _edges(model), model.region("face")
    steps = np.full(len(start), core + fade + 1)
    near = np.isin(np.arange(len(start)), vertices)
    for step in range(core + fade + 1):
        steps[near & (steps > step)] = step
        near = near | (edges @ near)
    reached = np.flatnonzero((steps <= core + fade) & face)
    count, label = connected_components(edges[reached][:, reached], directed=False)
    result = end.copy()
    for patch in range(count):
        at = reached[label == patch]
        share = np.clip((core + fade + 1 - steps[at]) / (fade + 1), 0, 1)[:, None]
        result[at] += share * (_nearest(start[at], end[at]) - end[at])
    return result


def _nearest(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Points (k, 3) moved by the affine map that brings them nearest to others (k, 3)."""
    X = np.column_stack([start - start.mean(0), np.ones(len(start))])
    ridge = _RIDGE * (X[:, :3] ** 2).sum() / 3 * np.diag([1.0, 1.0, 1.0, 0.0])
    return np.asarray(start + X @ np.linalg.solve(X.T @ X + ridge, X.T @ (end - start)))


@lru_cache(maxsize=4)
def _edges(model: MorphableModel) -> sp.csr_array:
    return sp.csr_array(adjacency(model.faces, len(model.mean)), dtype=bool)
