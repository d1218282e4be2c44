"""Expressions of a thinned head on all its vertices."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats, Integers, Singles
from toongeo.geometry import vertex_normals
from toongeo.geometry.facing_surface import FacingSurface
from toongeo.geometry.operators.vertex_components import vertex_components

__all__ = ["back_to_dense"]


def back_to_dense(V: Floats, F: Integers, kept: Integers, faces: Integers, shapes: Singles) -> Singles:
    """Displacements of every vertex, from those of the vertices that were kept.

    A vertex moves as the closest point of the thinned mesh that faces the same way, on the same part of the head.

    Parameters
    ----------
    V : (n, 3) float64
    F : (m, 3) int64
    kept : (c,) int64
    faces : (k, 3) int64
        Of :func:`thinned_mesh`.
    shapes : (e, c, 3) float32

    Returns
    -------
    (e, n, 3) float32
    """
    dense = np.zeros((len(shapes), len(V), 3), np.float32)
    part = vertex_components(F, len(V))
    coarse_part = part[kept]
    normals, places = vertex_normals(V, F), V[kept]
    for number in np.unique(coarse_part[faces[:, 0]]):
        own = faces[coarse_part[faces[:, 0]] == number]
        rows = np.flatnonzero(part == number)
        triangles, bary, _ = FacingSurface(places, own).closest(V[rows], normals[rows])
        corners = own[triangles]
        for target, shape in zip(dense, shapes, strict=True):  # one by one: all at once take gigabytes
            target[rows] = np.einsum("pc,pcd->pd", bary, shape[corners])
    dense[:, kept] = shapes
    return dense
