"""Anchors along the rims of eyes and lips, between the landmarks."""

from functools import lru_cache

import numpy as np
import scipy.sparse as sp
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.sparse.csgraph import dijkstra

from toongeo.model import MorphableModel

# iBUG-68 points from corner to corner of each rim. Lids are round: their displacement is interpolated by cubic splines.
# Lips touch: monotone interpolation, which never overshoots, keeps them from crossing.
LIDS = ((36, 37, 38, 39), (36, 41, 40, 39), (42, 43, 44, 45), (42, 47, 46, 45))
LIPS = (
    (48, 49, 50, 51, 52, 53, 54),
    (48, 59, 58, 57, 56, 55, 54),
    (60, 61, 62, 63, 64),
    (60, 67, 66, 65, 64),
)


def rim_anchors(model: MorphableModel, displacement: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices on the lid and lip rims between landmarks, and how they should move if the landmarks move so.

    A landmark moves one vertex; what lies between two of them follows only loosely. Rims are curves that the drawing
    shows, so the vertices along each take the displacement interpolated between its landmarks by arc length.

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
    for rim, path, knots in _rim_paths(model):
        known = [i for i, landmark in enumerate(rim) if seen[landmark]]
        if len(known) < 2:
            continue
        length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(model.mean[path], axis=0), axis=1))]
        values = displacement[[rim[i] for i in known]]
        interpolator = CubicSpline if rim in LIDS and len(known) > 2 else PchipInterpolator
        first, last = knots[known[0]], knots[known[-1]]
        between = np.setdiff1d(np.arange(first, last + 1), knots)
        vertices.append(path[between])
        moves.append(interpolator(length[knots[known]], values)(length[between]))
    if not vertices:
        return np.zeros(0, np.int64), np.zeros((0, displacement.shape[1]))
    found, first_at = np.unique(np.concatenate(vertices), return_index=True)
    free = ~np.isin(found, model.landmarks)
    return found[free], np.concatenate(moves)[first_at][free]


def rim_path(model: MorphableModel, rim: tuple[int, ...]) -> np.ndarray:
    """Vertices (k,) along one of the rims ``LIDS`` and ``LIPS``, from corner to corner, landmarks included."""
    return next(path for landmarks, path, _ in _rim_paths(model) if landmarks == rim)


@lru_cache(maxsize=4)
def _rim_paths(model: MorphableModel) -> list[tuple[tuple[int, ...], np.ndarray, np.ndarray]]:
    """For each rim its landmarks, the vertices from corner to corner, and where on that path the landmarks are."""
    near = np.any([model.region(name) for name in ("mouth", "eye_left", "eye_right", "lips")], axis=0)
    i, j = model.faces[:, [0, 1, 2]].ravel(), model.faces[:, [1, 2, 0]].ravel()
    i, j = np.r_[i, j], np.r_[j, i]
    inside = near[i] & near[j]
    i, j = i[inside], j[inside]
    n = len(model.mean)
    lengths = sp.csr_array((np.linalg.norm(model.mean[i] - model.mean[j], axis=1), (i, j)), shape=(n, n))
    lengths.data /= 2  # each edge was summed over its two triangles
    paths: list[tuple[tuple[int, ...], np.ndarray, np.ndarray]] = []
    for rim in (*LIDS, *LIPS):
        path = [int(model.landmarks[rim[0]])]
        knots = [0]
        for a, b in zip(rim[:-1], rim[1:], strict=True):
            _, previous = dijkstra(lengths, indices=int(model.landmarks[a]), return_predecessors=True)
            leg = [int(model.landmarks[b])]
            while leg[-1] != model.landmarks[a]:
                leg.append(int(previous[leg[-1]]))
            path += leg[-2::-1]
            knots.append(len(path) - 1)
        paths.append((rim, np.array(path), np.array(knots)))
    return paths
