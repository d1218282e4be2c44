"""Pairs of intersecting triangles of one mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.mesh_checks.box_pairs import box_pairs
from toongeo.geometry.mesh_checks.triangle_pairs import triangles_intersect
from toongeo.geometry.validate_mesh import MeshLike, validate_mesh

__all__ = ["self_intersections"]


def self_intersections(V: MeshLike, F: ArrayLike | None) -> NDArray[np.int64]:
    """Find all pairs of triangles of a mesh that intersect without being neighbours along an edge.

    Two triangles without a common vertex intersect if they have a point in common, contact included
    (mirror-symmetric meshes meet exactly edge on edge in their symmetry plane). Two triangles with one
    common vertex intersect if they meet elsewhere too. Coplanar triangles intersect if they share an area.
    Triangles with a common edge are never reported: see the folded edges of `toongeo.metrics.mesh_quality`.

    Parameters
    ----------
    V : (n, 3) float, or trimesh.Trimesh
        Vertices, any unit.
    F : (m, 3) int, or None with a Trimesh
        Triangles; degenerate ones are allowed.

    Returns
    -------
    (p, 2) int64
        Triangle numbers ``i < j``, rows sorted.

    Raises
    ------
    ValueError
        On a malformed mesh (see `validate_mesh`).

    Notes
    -----
    Floating point, not exact: distances below some 1e-14 of the mesh's size count as zero.

    Examples
    --------
    >>> V = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0.5, 0.5, -1], [0.5, 0.5, 1], [5, 5, 0]]
    >>> self_intersections(V, [[0, 1, 2], [3, 4, 5]])
    array([[0, 1]])
    """
    V, F = validate_mesh(V, F)
    low, high = V.min(axis=0), V.max(axis=0)
    diagonal = np.linalg.norm(high - low)
    X = ((V - (low + high) / 2) / (diagonal or 1.0)).T
    corners = np.ascontiguousarray(F.T)
    T = X[:, corners]
    found = [np.zeros((0, 2), dtype=np.int64)]
    for i, j in box_pairs(T.min(axis=1), T.max(axis=1)):
        hit = triangles_intersect(T, corners, i, j)
        found.append(np.stack([np.minimum(i[hit], j[hit]), np.maximum(i[hit], j[hit])], axis=1))
    pairs = np.concatenate(found)
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
