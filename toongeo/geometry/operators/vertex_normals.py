"""Area-weighted vertex normals."""

from __future__ import annotations

import igl
import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Floats
from toongeo.geometry.validate_mesh import MeshLike, validate_mesh

__all__ = ["vertex_normals"]


def vertex_normals(V: MeshLike, F: ArrayLike | None) -> Floats:
    """Unit vertex normals: the sum of the cross products of the triangles around, normalised.

    Parameters
    ----------
    V : (n, 3) float, or trimesh.Trimesh
        Vertices, any unit.
    F : (m, 3) int, or None with a Trimesh
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
    normals = igl.per_vertex_normals(V, F, igl.PER_VERTEX_NORMALS_WEIGHTING_TYPE_AREA)
    # libigl divides by the length without looking at it.
    return np.nan_to_num(normals, copy=False, nan=0.0)
