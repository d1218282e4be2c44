"""Anchors along the rims of eyes and lips, between the landmarks."""

from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.sparse.csgraph import dijkstra

from toongeo.geometry import adjacency
from toongeo.model import MorphableModel
from toongeo.model.ibug68 import LID_RIMS, LIP_RIMS


def rim_anchors(model: MorphableModel, displacement: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices on the lid and lip rims between landmarks, and how they should move if the landmarks move so.

    A landmark moves one vertex; what lies between two of them follows only loosely. Rims are curves that the drawing
    shows, so the vertices along each take the displacement interpolated between its landmarks by arc length: by cubic
    splines along lids, which are round, and by monotone ones along lips, which touch and must not overshoot.

    Parameters
    ----------
    model : MorphableModel
    displacement : (68, d) float
        Of the landmarks, in any frame; NaN rows are missing, and the rim next to them is left free.

    Returns
    -------
    vertices : (k,) int64
        None of them a landmark vertex, none twice.
    displacement : (k, d) float64
    """
    seen = np.isfinite(displacement).all(1)
    vertices, moves = [], []
    for name, (path, knots) in _rim_paths(model).items():
        rim = LID_RIMS.get(name) or LIP_RIMS[name]
        known = [i for i, landmark in enumerate(rim) if seen[landmark]]
        if len(known) < 2:
            continue
        length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(model.mean[path], axis=0), axis=1))]
        values = displacement[[rim[i] for i in known]]
        interpolator = CubicSpline if name in LID_RIMS and len(known) > 2 else PchipInterpolator
        first, last = knots[known[0]], knots[known[-1]]
        between = np.setdiff1d(np.arange(first, last + 1), knots)
        vertices.append(path[between])
        moves.append(interpolator(length[knots[known]], values)(length[between]))
    if not vertices:
        return np.zeros(0, np.int64), np.zeros((0, displacement.shape[1]))
    found, first_at = np.unique(np.concatenate(vertices), return_index=True)
    free = ~np.isin(found, model.landmarks)
    return found[free], np.concatenate(moves)[first_at][free]


def rim_path(model: MorphableModel, name: str) -> np.ndarray:
    """Vertices (k,) along a rim of :mod:`toongeo.model.ibug68`, from corner to corner, landmarks included."""
    return _rim_paths(model)[name][0]


@lru_cache(maxsize=4)
def _rim_paths(model: MorphableModel) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """For each rim its vertices from corner to corner, and where on that path its landmarks are."""
    parts = ("mouth", "eye_left", "eye_right", "lips")
    near = np.any([model.regions[name] for name in parts if name in model.regions], axis=0)
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
                leg.append(int(previous[leg[-1]]))
            path += leg[-2::-1]
            knots.append(len(path) - 1)
        paths[name] = np.array(path), np.array(knots)
    return paths
