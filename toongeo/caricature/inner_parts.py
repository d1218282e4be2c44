"""What no landmark sees follows the skin of a caricature.

Constants were chosen on the seven examples and eight caricatures (``toongeo bench caricature``).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.caricature.space.face_space import FaceSpace
from toongeo.geometry import self_intersections
from toongeo.pipeline.align.carry_inner_parts import carry_inner_parts

__all__ = ["tucked", "with_inner_parts"]

_ROUNDS = 3  # of pushing inwards; the best of them counts
_MARGIN = 0.3  # mm under the skin
_STEP = 1.0  # mm a round, at most


def with_inner_parts(space: FaceSpace, before: Floats, P: Floats, *, tuck: bool = True) -> Floats:
    """Vertices (n, 3) of the model for vertices (k, 3) of its space; the rest is carried along from ``before`` (n, 3).

    ``before`` is a face with the same opening of mouth and eyes, as far as possible.
    """
    V = before.copy()
    V[space.vertices] = P
    if len(space.vertices) == len(V):
        return V
    V = carry_inner_parts(space.model, before, V)
    V[space.vertices] = P
    if not tuck:
        return V
    inner = np.ones(len(V), bool)
    inner[space.vertices] = False
    return tucked(V, space.model.faces, inner, space.model.region("face"))


def tucked(V: Floats, F: NDArray[np.int64], inner: NDArray[np.bool_], skin: NDArray[np.bool_]) -> Floats:
    """Vertices (n, 3) with the ``inner`` ones (n,) that come through the ``skin`` (n,) pushed back under it.

    An inner vertex whose triangle crosses one of the skin goes below the plane of the latter, some tenths of a
    millimetre. As a triangle may cross several, this takes a few rounds, until one does not help. The skin stays.
    """
    of_skin, inside = np.asarray(skin[F].all(axis=1)), np.asarray(inner[F].any(axis=1))
    low, high = V[F[inside]].min(axis=(0, 1)), V[F[inside]].max(axis=(0, 1))
    corners = V[F]
    near = (corners.max(axis=1) >= low - _STEP).all(axis=1) & (corners.min(axis=1) <= high + _STEP).all(axis=1)
    numbers = np.flatnonzero((of_skin & near) | inside)
    best, fewest = V, len(F) ** 2
    for _ in range(_ROUNDS):
        pairs = numbers[self_intersections(V, F[numbers])]
        pairs = np.vstack([pairs, pairs[:, ::-1]])
        pairs = pairs[inside[pairs[:, 0]] & of_skin[pairs[:, 1]]]
        if len(pairs) >= fewest:
            break
        best, fewest = V, len(pairs)
        if not len(pairs):
            break
        V = V + _pushes(V, F[pairs[:, 0]], F[pairs[:, 1]], inner)
    return best


def _pushes(V: Floats, through: NDArray[np.int64], skin: NDArray[np.int64], inner: NDArray[np.bool_]) -> Floats:
    """Mean displacement (n, 3) that takes inner corners of triangles (p, 3) below the planes of triangles (p, 3)."""
    a = V[skin[:, 0]]
    normal = np.cross(V[skin[:, 1]] - a, V[skin[:, 2]] - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    depth = np.clip(np.einsum("pcj,pj->pc", V[through] - a[:, None], normal) + _MARGIN, 0, _STEP)
    pair, corner = np.nonzero(inner[through] & (depth > 0))
    target, push = through[pair, corner], -depth[pair, corner, None] * normal[pair]
    total = np.stack([np.bincount(target, column, len(V)) for column in push.T], axis=1)
    return total / np.maximum(np.bincount(target, minlength=len(V)), 1)[:, None]
