"""A face that follows another one in the large and keeps its own details.

Constants were chosen on the seven examples and eight caricatures (``toongeo bench caricature``).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator

from toongeo.arrays import Floats
from toongeo.caricature.space.face_space import FaceSpace
from toongeo.geometry.one_thread import one_thread
from toongeo.model.anatomy.landmark_basis import landmark_basis

__all__ = ["smooth_warp", "spread_rows"]

_OF_FACE, _OF_HEAD = 150, 75  # nodes beside the landmarks


def smooth_warp(space: FaceSpace, V: Floats, target: Floats, looseness: float) -> Floats:
    """Move a face by the smooth map of space that takes some of its skin to another one.

    A mesh of a deformation space meets its gradients in the mean; lips and lids can pass through each other, as its
    rings know nothing of what lies beside them. A smooth map of space moves both sides of a gap alike. It is a
    smoothing spline (cubic radial functions and an affine part) through the displacements of two hundred vertices that
    are spread over the skin, all landmarks among them.

    Parameters
    ----------
    space : FaceSpace
    V : (n, 3) float, mm
        Vertices of the model.
    target : (k, 3) float, mm
        Vertices of the space.
    looseness : float >= 0
        Of the spline, lengths in outer-eye distances; 0 interpolates.

    Returns
    -------
    (n, 3) float64
        What the space does not deform stays.
    """
    rows, unit = _nodes(space), landmark_basis(space.model).outer_eye_mm
    at = V[space.vertices[rows]]
    with one_thread():
        spline = RBFInterpolator(at / unit, target[rows] - at, kernel="cubic", degree=1, smoothing=looseness)
        moved = V.copy()
        moved[space.vertices] += spline(V[space.vertices] / unit)
    return moved


def spread_rows(V: Floats, count: int) -> NDArray[np.int64]:
    """Rows (count,) of points (n, 3), each the farthest from those before it."""
    distances = np.full(len(V), np.inf)
    rows = [int(np.linalg.norm(V - V.mean(axis=0), axis=1).argmax())]
    while len(rows) < count:
        distances = np.minimum(distances, ((V - V[rows[-1]]) ** 2).sum(axis=1))
        rows.append(int(distances.argmax()))
    return np.array(rows)


@lru_cache(maxsize=2)
def _nodes(space: FaceSpace) -> NDArray[np.int64]:
    V = space.space.reference
    face = np.flatnonzero(space.model.region("face")[space.vertices])
    spread = (face[spread_rows(V[face], min(_OF_FACE, len(face)))], spread_rows(V, min(_OF_HEAD, len(V))))
    return np.unique(np.concatenate([space.rows(space.model.landmarks), *spread]))
