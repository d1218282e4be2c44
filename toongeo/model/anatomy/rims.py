"""Rims of the openings of a head, and paths along them."""

from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import dijkstra

from toongeo.geometry.operators.adjacency import adjacency
from toongeo.model.ibug68 import LID_RIMS, LIP_RIMS
from toongeo.model.morphable_model import MorphableModel

__all__ = ["opening_rim", "rim_path", "rim_paths"]


def opening_rim(model: MorphableModel, part: str) -> np.ndarray:
    """Skin vertices (k,) that share a triangle with an inner part: lid margins, inner lips."""
    inside = model.region(part)
    touching = model.faces[inside[model.faces].any(1)]
    return np.setdiff1d(touching, np.flatnonzero(inside))


def rim_path(model: MorphableModel, name: str) -> np.ndarray:
    """Vertices (k,) along a rim of :mod:`toongeo.model.ibug68`, from corner to corner, landmarks included."""
    return rim_paths(model)[name][0]


@lru_cache(maxsize=4)
def rim_paths(model: MorphableModel) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """For each rim its vertices from corner to corner, and where on that path its landmarks are.

    Between two landmarks that no edges join there is nothing.
    """
    near = np.any([model.region(name) for name in ("mouth", "eye_left", "eye_right", "lips")], axis=0)
    if not model.has("mouth", "eye_left", "eye_right"):
        near |= True
    A = adjacency(model.faces, len(model.mean)).tocoo()
    inside = near[A.row] & near[A.col]
    i, j = A.row[inside], A.col[inside]
    lengths = sp.csr_array((np.linalg.norm(model.mean[i] - model.mean[j], axis=1), (i, j)), shape=A.shape)
    paths = {}
    for name, rim in (*LID_RIMS.items(), *LIP_RIMS.items()):
        path = [int(model.landmarks[rim[0]])]
        knots = [0]
        for a, b in zip(rim[:-1], rim[1:], strict=True):
            _, previous = dijkstra(lengths, indices=int(model.landmarks[a]), return_predecessors=True)
            leg = [int(model.landmarks[b])]
            while leg[-1] != model.landmarks[a]:
                before = int(previous[leg[-1]])
                leg.append(before if before >= 0 else int(model.landmarks[a]))
            path += leg[-2::-1]
            knots.append(len(path) - 1)
        paths[name] = np.array(path), np.array(knots)
    return paths
