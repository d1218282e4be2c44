"""Landmarks, given as vertices or as points, as rows that interpolate between vertices."""

from __future__ import annotations

import igl
import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.facing_surface import barycentric

__all__ = ["landmark_matrix"]


def landmark_matrix(
    V: NDArray[np.float64], F: NDArray[np.int64], landmarks: ArrayLike, name: str
) -> tuple[sp.csr_matrix, NDArray[np.bool_]]:
    """Matrix (k, n) with ``matrix @ V`` the landmarks, and which of them (k,) are given.

    Parameters
    ----------
    V, F
        A checked mesh.
    landmarks : (k,) int or (k, 3) float
        Vertices, or points, of which the closest ones of the mesh are taken; rows with NaN are missing.
    name
        What to call the landmarks in messages.

    Raises
    ------
    ValueError
        On another shape or type, an index out of range, or infinite coordinates.

    Examples
    --------
    >>> V, F = np.eye(3), np.array([[0, 1, 2]])
    >>> matrix, given = landmark_matrix(V, F, [[1.0, 0, 0], [np.nan, 0, 0]], "landmarks")
    >>> matrix.toarray(), given
    (array([[1., 0., 0.], [0., 0., 0.]]), array([ True, False]))
    """
    array = np.asarray(landmarks)
    n = len(V)
    if array.ndim == 1 and array.dtype.kind in "iu" and len(array):
        outside = (array < 0) | (array >= n)
        if outside.any():
            raise ValueError(f"{name}: expected vertex indices in 0..{n - 1}, got {array[outside.argmax()]}")
        rows = np.arange(len(array))
        return sp.csr_matrix((np.ones(len(array)), (rows, array)), shape=(len(array), n)), np.ones(len(array), bool)
    if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "fiu" or not len(array):
        got = f"{array.dtype} {array.shape}"
        raise ValueError(f"{name}: expected vertex indices (k,) or points (k, 3), k >= 1, got {got}")
    points = array.astype(np.float64)
    if np.isinf(points).any():
        raise ValueError(
            f"{name}: expected finite coordinates or NaN, got infinity in row {np.isinf(points).any(1).argmax()}"
        )
    given = np.ones(len(points), bool)
    given[np.isnan(points).any(axis=1)] = False
    rows = np.flatnonzero(given)
    if not len(rows):
        return sp.csr_matrix((len(points), n)), given
    at = np.ascontiguousarray(points[rows])
    triangles = igl.point_mesh_squared_distance(at, V, F)[1].astype(np.int64)
    bary = barycentric(at, V[F[triangles]])
    entries = bary.ravel(), (np.repeat(rows, 3), F[triangles].ravel())
    return sp.csr_matrix(entries, shape=(len(points), n)), given
