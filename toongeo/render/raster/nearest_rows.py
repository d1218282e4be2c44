"""The nearest face of each pixel, by the quickest way that there is."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats, Integers, Singles
from toongeo.render.raster.opencv_nearest import opencv_nearest
from toongeo.render.raster.z_buffer import z_buffer

__all__ = ["nearest_rows"]

_ROUNDING = 2.5e-7  # of the image's side: what the float32 projection may move a point by
_MAX_GROWTH = 0.002  # of a face's own size, for slivers


def nearest_rows(points: Floats, faces: Integers, affine: Floats, height: int, width: int) -> NDArray[np.int32]:
    """Row (height, width) int32 of the face (m, 3) that is nearest at each pixel centre, -1 where there is none.

    Points (n, 3) are x, y in px and the depth, larger is nearer; ``affine`` (m, 6) is as of `affine_weights`.
    """
    growth = _growth(affine, height, width)
    if hasattr(cv2, "triangleRasterizeColor"):  # OpenCV 5, unless built without it
        return opencv_nearest(points, faces, growth, height, width)
    return z_buffer(points, faces, affine, growth, height, width)


def _growth(affine: Floats, height: int, width: int) -> Singles:
    """By which part of its size (m,) a face must grow for its edges to move out by the rounding error.

    A pixel centre on an edge then belongs to the faces on both sides; else float32 opens cracks between them.
    """
    gx1, gy1, gx2, gy2 = affine[:, 0], affine[:, 1], affine[:, 3], affine[:, 4]
    steepest = np.maximum(np.abs(gx1) + np.abs(gy1), np.abs(gx2) + np.abs(gy2))  # 1 / height of the face
    steepest = np.maximum(steepest, np.abs(gx1 + gx2) + np.abs(gy1 + gy2))
    distance = 3.0 * _ROUNDING * max(height, width)  # the centroid has the weights 1/3
    return np.minimum(distance * steepest, _MAX_GROWTH).astype(np.float32)
