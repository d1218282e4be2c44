"""Jaw points: where they lie on the head at a given pose, and how much each direction counts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.operators.cross import cross
from toongeo.model.anatomy.landmark_basis import LandmarkBasis
from toongeo.model.ibug68 import PARTS

__all__ = ["jaw_weights", "landmarks_seen", "visible_landmarks"]


def visible_landmarks(
    basis: LandmarkBasis, coefficients: NDArray[np.float64], rotation: NDArray[np.float64]
) -> NDArray[np.int64]:
    """The 68 landmark vertices at a pose: each jaw point slides along its contour line.

    It takes the first vertex from the front whose normal turns away from the camera (``n . view <= 0``):
    there the outline of the head is. A line that is seen to its end gives its last vertex, the point on
    the jaw bone.

    Parameters
    ----------
    basis : LandmarkBasis
    coefficients : (c,) float
    rotation : (3, 3), model to camera frame

    Returns
    -------
    (68,) int64
    """
    return landmarks_seen(basis, basis.positions(coefficients), rotation)


def landmarks_seen(
    basis: LandmarkBasis, points: NDArray[np.float64], rotation: NDArray[np.float64]
) -> NDArray[np.int64]:
    """`visible_landmarks` of any shape, given by its points (k, 3) at the vertices of ``basis``."""
    rows = basis.line_rows
    turned = _towards(points, basis.fan, rotation[2])[rows] <= 0
    last = np.append(basis.line_starts[1:], len(rows)) - 1
    first = np.minimum.reduceat(np.where(turned, np.arange(len(rows)), len(rows)), basis.line_starts)
    landmarks = basis.landmarks.copy()
    landmarks[PARTS["jaw"]] = basis.vertices[rows[np.minimum(first, last)]]
    return landmarks


def _towards(X: NDArray[np.float64], faces: NDArray[np.int64], view: NDArray[np.float64]) -> NDArray[np.float64]:
    """Component along ``view`` of the area-weighted vertex normals; only its sign is meant."""
    a, b, c = X.T[:, faces.T].transpose(1, 0, 2)
    along = view @ cross(b - a, c - a)
    return np.bincount(faces.ravel(), np.repeat(along, 3), len(X)).astype(np.float64)


def jaw_weights(points: NDArray[np.float64], tangent_weight: float) -> NDArray[np.float64]:
    """Weight matrices (17, 2, 2) of the jaw points: 1 across the outline, less along it.

    An annotator knows the outline but not how far along it a point belongs, so the error ``e`` of a point
    costs ``(n . e)^2 + (tangent_weight * t . e)^2`` with the outline's normal n and tangent t at this
    point. The tangent comes from the neighbours that are there; a point without any counts alike in all
    directions.

    Parameters
    ----------
    points : (17, 2) float
        Jaw points in any similar frame; NaN rows are missing and weigh nothing.
    tangent_weight : float in [0, 1]
    """
    weights = np.zeros((len(points), 2, 2))
    there = np.flatnonzero(np.isfinite(points).all(axis=1))
    weights[there] = np.eye(2)
    if len(there) < 2:
        return weights
    tangents = np.gradient(points[there], axis=0)
    lengths = np.linalg.norm(tangents, axis=1)
    known = lengths > 0
    t = tangents[known] / lengths[known, None]
    weights[there[known]] -= (1 - tangent_weight**2) * t[:, :, None] * t[:, None, :]
    return weights
