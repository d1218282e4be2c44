"""Deformation gradients of the one-rings of a mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.operators.one_rings import one_rings
from toongeo.geometry.validate_mesh import MeshLike, validate_vertices

__all__ = ["deformation_gradients"]


def deformation_gradients(V: MeshLike, F: ArrayLike | None, P: ArrayLike) -> NDArray[np.float64]:
    """Affine matrix of each vertex's one-ring from a reference mesh to a deformed one.

    ``T_i`` minimizes ``sum_j c_ij |e'_ij - T_i e_ij|^2`` with cotangent weights of the reference (Eq. 1), brought
    into [0.01, 100]. A ring of a smooth surface is nearly flat, and its edges tell next to nothing about the direction
    of its normal: there the gradient is tied, with a thousandth of the ring's own weight, to that of the ring
    together with its neighbours'. This keeps the map linear in the deformed vertices, and affine deformations exact.
    Where all these rings lie in one plane, the gradient takes the normal to the normal of the deformed ring, scaled
    by the root of the growth of area.

    Parameters
    ----------
    V : (n, 3) float, or trimesh.Trimesh
        Vertices of the reference.
    F : (m, 3) int, or None with a Trimesh
        Triangles.
    P : (n, 3) float
        Deformed vertices, in the unit and frame of the reference.

    Returns
    -------
    (n, 3, 3) float64
        ``e'`` is about ``T @ e``.

    Raises
    ------
    ValueError
        On a malformed mesh, a triangle without area, a vertex in no triangle, or shapes of `V` and `P` that differ.

    See Also
    --------
    one_rings : prefactored, for many deformed meshes.

    References
    ----------
    Wu et al. 2018, "Alive caricature from 2D to 3D", Eq. 1.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> F = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> deformation_gradients(V, F, V * [2, 1, 1])[0].round(9) + 0.0
    array([[2., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    rings = one_rings(V, F)
    P = validate_vertices(P, name="P")
    if P.shape != rings.V.shape:
        raise ValueError(f"P: expected shape {rings.V.shape} as V, got {P.shape}")
    D = rings.displacement_gradients(P).transpose(2, 0, 1)
    return np.ascontiguousarray(D + np.eye(3))
