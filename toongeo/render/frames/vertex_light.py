"""Light that comes from the vertices of a mesh that moves."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from toongeo.arrays import Floats, Integers, Singles
from toongeo.render.spherical_harmonics import irradiance

__all__ = ["VertexLight"]


class VertexLight:
    """Lambert's light at albedo 1, in single precision: a third of the time of normals and harmonics for any mesh.

    Parameters
    ----------
    faces : (m, 3) int
    count : int
        Of the vertices.
    light : (9, c), c = 1 or 3
        Radiance in spherical harmonics, camera frame, as of `irradiance`.
    """

    def __init__(self, faces: Integers, count: int, light: Floats) -> None:
        self._corners = np.ascontiguousarray(faces.T, np.intp)
        entries = np.ones(faces.size, np.float32), (faces.ravel(), np.repeat(np.arange(len(faces)), 3))
        self._around = sp.csr_matrix(entries, (count, len(faces)))  # sums the faces around a vertex
        linear, square = _forms(np.broadcast_to(light, (len(light), 3)))
        channels = light.shape[1]
        self._linear, self._square = linear[:, :channels].astype(np.float32), square[:channels].astype(np.float32)

    def of(self, points: Floats) -> Singles:
        """Linear light (n, c) of the points (n, 3) in the camera frame."""
        normals = self._normals(points.astype(np.float32))
        squares = [np.einsum("ni,ni->n", normals @ square, normals) for square in self._square]
        return np.maximum(normals @ self._linear + np.stack(squares, axis=1), np.float32(0))

    def _normals(self, points: Singles) -> Singles:
        """Unit normals (n, 3), by area; 0 where there is no face."""
        ux, uy, uz, vx, vy, vz = (
            along.take(corner) - along.take(self._corners[0])
            for corner in self._corners[1:]
            for along in np.ascontiguousarray(points.T)
        )
        crosses = np.stack([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx], axis=1)
        normals = np.asarray(self._around @ crosses)
        length = np.sqrt(np.einsum("ni,ni->n", normals, normals))
        return np.asarray(normals / np.where(length > 0, length, np.float32(1))[:, None], np.float32)


def _forms(light: Floats) -> tuple[Floats, Floats]:
    """Irradiance / pi as b n + n Q n of a unit normal n: b (3, c) and Q (c, 3, 3).

    There are such b and Q (Ramamoorthi & Hanrahan 2001, Eq. 11), since n n = 1; they are read off at ten normals.
    """
    axes = np.eye(3)
    to, fro = (irradiance(sign * axes, light) / np.pi for sign in (1, -1))
    linear = (to - fro) / 2
    square = np.einsum("ic,ij->cij", (to + fro) / 2, axes)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        between = (axes[i] + axes[j]) / np.sqrt(2)
        rest = irradiance(between[None], light)[0] / np.pi - between @ linear
        square[:, i, j] = square[:, j, i] = rest - (square[:, i, i] + square[:, j, j]) / 2
    return linear, square
