"""Attributes of the vertices at the pixels where they are seen."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats, Singles
from toongeo.render.raster.affine_weights import affine_weights
from toongeo.render.raster.nearest_rows import nearest_rows
from toongeo.render.raster.opencv_space import opencv_space

__all__ = ["NOTHING", "VertexShader"]

NOTHING = 2.0  # distance where there is no face
# Distances of the nearest and the farthest point. OpenCV interpolates in perspective; over so short a way it is linear
# in the picture, to 1/600 of a triangle, and float32 still tells some 80,000 depths apart.
_NEAR, _FAR = 1.49, 1.5


class VertexShader:
    """Draws attributes of vertices, interpolated in the nearest faces.

    Parameters
    ----------
    points : (n, 3)
        x, y in px and the depth, larger is nearer.
    attributes : (n, c) float32
        c is a multiple of 3.
    size : int
        Side of the picture, px.

    Attributes
    ----------
    depth_unit : float
        How much depth a unit of distance is.
    """

    def __init__(self, points: Floats, attributes: Singles, size: int) -> None:
        depth = points[:, 2]
        highest, lowest = float(depth.max()), float(depth.min())
        self.depth_unit = max(highest - lowest, float(np.finfo(np.float32).tiny)) / (_FAR - _NEAR)
        self._points, self._attributes, self._size = points, attributes, size
        self._distance = _NEAR + (highest - depth) / self.depth_unit
        self._space = opencv_space(points, self._distance, size, size)

    def draw(self, faces: NDArray[np.integer], finer: int = 1) -> tuple[Singles, Singles]:
        """Values (s, s, c) and distances (s, s) at the centres of pixels that are ``finer`` times smaller.

        Faces (m, 3) are int32. Where there is none the distance is `NOTHING`, and the values are anything.
        """
        side, columns = finer * self._size, self._attributes.shape[1]
        if not hasattr(cv2, "triangleRasterize"):  # before OpenCV 5, or built without it
            return self._by_rows(faces, finer)
        settings = cv2.TriangleRasterizeSettings()
        settings.setShadingType(cv2.RASTERIZE_SHADING_SHADED)
        settings.setCullingMode(cv2.RASTERIZE_CULLING_NONE)
        drawn = []
        for three in np.split(self._attributes, columns // 3, axis=1):
            values, distance = np.empty((side, side, 3), np.float32), np.full((side, side), NOTHING, np.float32)
            if len(faces):
                arguments = self._space, faces, np.ascontiguousarray(three), values, distance
                cv2.triangleRasterize(*arguments, np.eye(4), np.pi / 2, 1.0, NOTHING, settings)
            drawn.append(values)
        return drawn[0] if columns == 3 else np.concatenate(drawn, axis=2), distance

    def _by_rows(self, faces: NDArray[np.integer], finer: int) -> tuple[Singles, Singles]:
        """The same, slower."""
        side = finer * self._size
        points = (self._points + [0.5, 0.5, 0.0]) * [finer, finer, 1.0] - [0.5, 0.5, 0.0]
        corners = faces.astype(np.int64)
        affine, _ = affine_weights(points, corners)
        rows = nearest_rows(points, corners, affine, side, side)
        y, x = np.nonzero(rows >= 0)
        seen = rows[y, x]
        gx1, gy1, g01, gx2, gy2, g02 = affine[seen].T
        second, third = gx1 * x + gy1 * y + g01, gx2 * x + gy2 * y + g02
        weights = np.stack([1.0 - second - third, second, third], axis=1)
        values = np.empty((side, side, self._attributes.shape[1]), np.float32)
        distance = np.full((side, side), NOTHING, np.float32)
        values[y, x] = np.einsum("ki,kic->kc", weights, self._attributes[corners[seen]])
        distance[y, x] = np.einsum("ki,ki->k", weights, self._distance[corners[seen]])
        return values, distance
