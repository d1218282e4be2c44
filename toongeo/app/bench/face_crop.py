"""The square of a picture in which faces are measured and shown."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.metrics import face_square
from toongeo.metrics.landmark_distance import CROP_PX
from toongeo.protocols import HeadCamera

__all__ = ["FaceCrop", "face_crop"]

PAPER = 255  # what lies beyond the picture


@dataclass(frozen=True, eq=False)
class FaceCrop:
    """A face cut out and resampled.

    Attributes
    ----------
    pixels : (size, size, 3) uint8 RGB
    inside : (size, size) bool
        Where nothing from beyond the border of the picture is mixed in.
    corner : (2,) float, px of the picture
        Pixel centre of the picture that becomes the first of the crop.
    scale : float
        Pixels of the crop per pixel of the picture.
    """

    pixels: NDArray[np.uint8]
    inside: NDArray[np.bool_]
    corner: NDArray[np.float64]
    scale: float

    def camera(self, camera: HeadCamera) -> HeadCamera:
        """The camera of the picture as that of the crop."""
        return camera.cropped(self.corner, self.scale)


def face_crop(img: NDArray[np.uint8], landmarks: NDArray[np.float64], size: int = CROP_PX) -> FaceCrop:
    """The face of a picture, area-filtered to a square of fixed size.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
    size : int
        Side of the crop, px.
    """
    edge, side = face_square(landmarks)
    scale = size / side
    # First at a whole multiple of the size, no coarser than the picture; then whole blocks are averaged.
    finer = max(1, math.ceil(1 / scale))
    step = scale * finer
    shift = step * (0.5 - edge) - 0.5
    large = cv2.warpAffine(
        img,
        np.array([[step, 0, shift[0]], [0, step, shift[1]]]),
        (size * finer, size * finer),
        flags=cv2.INTER_LINEAR,
        borderValue=(PAPER,) * 3,
    )
    pixels = np.asarray(cv2.resize(large, (size, size), interpolation=cv2.INTER_AREA), np.uint8)
    corner = edge - 0.5 + 0.5 / scale
    x, y = (corner[k] + np.arange(size) / scale for k in range(2))
    reach = 0.5 / scale * (1 - 1 / finer)  # from the centre of a block to that of its outermost sample
    height, width = img.shape[:2]
    inside = ((y >= reach) & (y <= height - 1 - reach))[:, None] & ((x >= reach) & (x <= width - 1 - reach))
    return FaceCrop(pixels, inside, corner, scale)
