"""The nearest face of each pixel by the rasterizer of OpenCV 5."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats, Integers, Singles
from toongeo.render.raster.opencv_space import opencv_space

__all__ = ["opencv_nearest"]

_NEAREST, _FARTHEST = 0.99, 0.01  # depths in OpenCV's buffer, within (0, 1)


def opencv_nearest(
    points: Floats,
    faces: Integers,
    growth: Singles,
    height: int,
    width: int,
) -> NDArray[np.int32]:
    """Row of the nearest face at each pixel: FLAT shading gives a face the colour of its first vertex.

    OpenCV knows only a perspective camera. At fovY = pi/2, near 1, far 2, a point at the distance d = 2 / (2 - t) gets
    the buffer depth t, which keeps the depth linear.
    """
    colours = np.full((height, width, 3), -1.0, np.float32)
    if len(faces) == 0:
        return colours[:, :, 0].astype(np.int32)
    depth = points[:, 2]
    lowest, highest = depth[faces].min(), depth[faces].max()
    if highest > lowest:
        nearness = (depth - lowest) * ((_NEAREST - _FARTHEST) / (highest - lowest))
        d = 2.0 / (2.0 - _NEAREST + nearness)
    else:
        d = np.ones(len(points))  # divides without rounding
    space = opencv_space(points, d, height, width)
    corners = space.take(faces, axis=0)
    middle = (corners[:, 0] + corners[:, 1] + corners[:, 2]) / np.float32(3.0)
    corners += (corners - middle[:, None]) * growth[:, None, None]
    settings = cv2.TriangleRasterizeSettings()
    settings.setShadingType(cv2.RASTERIZE_SHADING_FLAT)
    settings.setCullingMode(cv2.RASTERIZE_CULLING_NONE)
    cv2.triangleRasterizeColor(
        corners.reshape(-1, 3),
        np.arange(corners.size // 3, dtype=np.int32).reshape(-1, 3),
        np.repeat(np.arange(len(faces), dtype=np.float32), 9).reshape(-1, 3),
        colours,
        np.eye(4),
        np.pi / 2.0,
        1.0,
        2.0,
        settings,
    )
    return colours[:, :, 0].astype(np.int32)
