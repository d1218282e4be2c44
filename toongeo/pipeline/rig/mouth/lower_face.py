"""How sound the skin around a mouth is, and how it is smoothed where it crosses itself."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from toongeo.geometry import adjacency
from toongeo.geometry.operators.factor import factor_spd, solve
from toongeo.geometry.self_intersections import self_intersections
from toongeo.model import MorphableModel
from toongeo.model.anatomy.motion_shares import motion_shares

__all__ = ["LowerFace", "crossing_count", "crossings", "lower_face", "strain", "uncrossed"]

_ROUNDS = 4  # of smoothing, each over one ring of vertices more where the last one did not help
_RINGS = 2  # around crossing triangles that are smoothed at first
_STAY = 1e-6  # of the energy of bending: keeps the system definite


class LowerFace(NamedTuple):
    """Vertices (k,) of the skin around the mouth, and triangles (t, 3) among them, by their place in ``vertices``."""

    vertices: np.ndarray
    faces: np.ndarray


@lru_cache(maxsize=4)
def lower_face(model: MorphableModel) -> LowerFace:
    """The face as far as an opening jaw or the lips move it, with the nose above them."""
    used, F = np.unique(model.faces[_triangles(model)], return_inverse=True)
    return LowerFace(used, F.reshape(-1, 3))


def crossing_count(model: MorphableModel, V: np.ndarray) -> int:
    """How many triangles of the face around the mouth intersect others of it."""
    return len(crossings(model, V))


def strain(model: MorphableModel, V: np.ndarray, W: np.ndarray) -> float:
    """To how many times its length the skin is stretched from V to W (n, 3): the 99th percentile over triangles."""
    F = model.faces[_triangles(model)]
    J = _frames(W, F) @ np.linalg.inv(_frames(V, F))
    a, b, c, d = J.reshape(-1, 4).T
    return float(np.percentile(np.hypot(a + d, c - b) + np.hypot(a - d, b + c), 99) / 2)


def uncrossed(model: MorphableModel, V: np.ndarray) -> np.ndarray:
    """Vertices with the skin around crossing triangles bent as little as can be, as long as that helps."""
    best, crossing, rings = V, crossings(model, V), _RINGS
    edges = adjacency(model.faces, len(V)).astype(float).tocsr()
    degree = np.asarray(edges.sum(1)).ravel()
    bent = sp.eye_array(len(V)) - sp.diags_array(1 / np.maximum(degree, 1)) @ edges
    energy = sp.csr_matrix(bent.T @ bent)
    held = ~model.region("face") | model.region("eye_left") | model.region("eye_right")
    for _ in range(_ROUNDS):
        if not len(crossing):
            break
        near = np.zeros(len(V))
        near[model.faces[crossing]] = 1
        for _ring in range(rings):
            near = np.minimum(near + edges @ near, 1)
        free = np.flatnonzero((near > 0) & ~held)
        rest = np.setdiff1d(np.flatnonzero(degree), free)
        tried = best.copy()
        stay = _STAY * sp.eye_array(len(free))
        right = _STAY * best[free] - energy[free][:, rest] @ best[rest]
        tried[free] = solve(factor_spd(energy[free][:, free] + stay), right)
        found = crossings(model, tried)
        if len(found) < len(crossing):
            best, crossing = tried, found
        else:
            rings += 1
    return best


def crossings(model: MorphableModel, V: np.ndarray) -> np.ndarray:
    """Triangles (c,) of the model, around its mouth, that intersect others there."""
    patch = lower_face(model)
    return _triangles(model)[np.unique(self_intersections(V[patch.vertices], patch.faces))]


def _frames(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Edges (m, 2, 2) of triangles as columns, each in its own plane."""
    first, second = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]
    length = np.maximum(np.linalg.norm(first, axis=1), 1e-9)
    height = np.maximum(np.linalg.norm(np.cross(first, second), axis=1) / length, 1e-9)
    frames = np.zeros((len(F), 2, 2))
    frames[:, 0, 0], frames[:, 0, 1], frames[:, 1, 1] = length, (first * second).sum(1) / length, height
    return frames


@lru_cache(maxsize=4)
def _triangles(model: MorphableModel) -> np.ndarray:
    """Triangles (t,) of the face that an opening jaw or the lips move, with the nose above them."""
    names = ("jawOpen", "mouthSmileLeft", "mouthSmileRight")
    moves = motion_shares(model)[[model.expression_index(name) for name in names if model.has(name)]].any(0)
    some = (moves | model.region("nose"))[model.faces].any(1)
    return np.flatnonzero(some & model.region("face")[model.faces].all(1))
