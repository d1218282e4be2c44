"""Components without an anchor, which may follow what they lie next to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toongeo.geometry.one_thread import one_thread
from toongeo.geometry.rotations.nearest_rotation import nearest_rotation

__all__ = ["follow", "loose_parts"]


def loose_parts(
    V: NDArray[np.float64], component: NDArray[np.int64], held: NDArray[np.bool_]
) -> list[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """For each component whose vertices are not held: its vertices, and the held ones that are nearest to them."""
    base = np.flatnonzero(held)
    tree = cKDTree(V[base])
    parts = [np.flatnonzero(component == c) for c in np.unique(component[~held])]
    return [(part, base[np.unique(tree.query(V[part])[1])]) for part in parts]


def follow(
    parts: list[tuple[NDArray[np.int64], NDArray[np.int64]]], rest: NDArray[np.float64], moved: NDArray[np.float64]
) -> None:
    """Move each part in `moved` by the rigid motion (Kabsch) of the vertices next to it."""
    for part, near in parts:
        centre, arrived = rest[near].mean(axis=0), moved[near].mean(axis=0)
        with one_thread():
            # The little of the identity keeps the turn that near vertices on a line or at a point leave open at none.
            spread = (rest[near] - centre).T @ (rest[near] - centre)
            covariance = (moved[near] - arrived).T @ (rest[near] - centre) + 1e-9 * np.trace(spread) * np.eye(3)
            turn = nearest_rotation(covariance if np.trace(spread) > 0 else np.eye(3))
            moved[part] = (rest[part] - centre) @ turn.T + arrived
