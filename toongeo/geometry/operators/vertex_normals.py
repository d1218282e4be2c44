"""Area-weighted vertex normals."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.operators.cross import cross
from toongeo.geometry.validate_mesh import validate_mesh

__all__ = ["vertex_normals"]


def vertex_normals(V: ArrayLike, F: ArrayLike) -> NDArray[np.float64]:
    """Unit vertex normals: the sum of the cross products of the triangles around, normalised.

    Parameters
    ----------
    V : (n, 3) float
        Vertices, any unit.
    F : (m, 3) int
        Triangles, counter-clockwise from outside.

    Returns
    -------
    (n, 3) float64
        Outward unit normals. A vertex without a triangle, or whose triangles cancel, has the zero vector:
        no direction is better than another there, and nothing downstream turns into NaN.

    Raises
    ------
    ValueError
        On a malformed mesh (see `validate_mesh`). Degenerate triangles are allowed: they weigh nothing.

    Examples
    --------
    >>> vertex_normals([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])[0]
    array([0., 0., 1.])
    """
    V, F = validate_mesh(V, F)
    # Coordinates as rows: gathers and products then run over contiguous memory.
    X = np.ascontiguousarray(V.T)
    corners = np.ascontiguousarray(F.T)
    a, b, c = (X[:, corner] for corner in corners)
    area = cross(b - a, c - a)
    flat, thrice = corners.ravel(), np.concatenate([area, area, area], axis=1)
    total = np.stack([np.bincount(flat, weights=row, minlength=len(V)) for row in thrice], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.divide(total, length, out=np.zeros_like(total), where=length > 0)
