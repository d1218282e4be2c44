"""Meshes of an avatar as one, with colours at its vertices."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from toongeo.arrays import Bytes, Floats, Integers
from toongeo.avatar.looks.uv_colours import uv_colours
from toongeo.io import SceneMesh, split_seams

__all__ = ["coloured_points"]


def coloured_points(meshes: Sequence[SceneMesh]) -> tuple[Floats, Integers, Bytes, Floats]:
    """Vertices (n, 3), triangles (m, 3), the textures' colours (n, 3) uint8 and uv (n, 2) of all meshes in one.

    Vertices keep their order; those on seams, which have several uv, come again at the end. What has no texture, as the
    end of the neck, has one uv, in a corner.
    """
    points = _joined([(mesh.vertices, mesh.faces) for mesh in meshes])
    uvs = _joined([_uv(mesh) for mesh in meshes])
    vertex, corner, split = split_seams(points[1], uvs[1])
    again = np.r_[False, vertex[1:] == vertex[:-1]]
    order = np.argsort(again, kind="stable")
    looks = np.vstack([255 * np.array([mesh.color]) if mesh.uv is None else uv_colours(mesh) for mesh in meshes])
    colours = np.rint(looks[corner[order]]).astype(np.uint8)
    return points[0][vertex[order]], np.argsort(order)[split], colours, uvs[0][corner[order]]


def _uv(mesh: SceneMesh) -> tuple[np.ndarray, np.ndarray]:
    if mesh.uv is None or mesh.uv_faces is None:
        return np.zeros((1, 2)), 0 * mesh.faces
    return mesh.uv, mesh.uv_faces


def _joined(parts: list[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """Rows of all parts, and indices into them."""
    offsets = np.cumsum([0, *(len(rows) for rows, _ in parts)])
    indices = [index + offset for (_, index), offset in zip(parts, offsets, strict=False)]
    return np.vstack([rows for rows, _ in parts]), np.vstack(indices)
