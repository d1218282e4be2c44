"""The surroundings of a head, always of about the same size, in which a picture is parsed.

Constants were chosen by eye on the seven examples and 15 caricatures.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats

__all__ = ["WorkingView", "working_view"]

_MARGIN = 0.5  # of the head's size, on all sides: so far its hair is looked for


@dataclass(frozen=True, eq=False)
class WorkingView:
    """A resized crop of a picture.

    Attributes
    ----------
    pixels : (h, w, 3) uint8 RGB
    corner : (2,) int
        Pixel x, y of the picture where the crop begins.
    size : (2,) int
        Width and height of the crop in the picture, px.
    head : float
        Size of the head, px of the view.
    """

    pixels: NDArray[np.uint8]
    corner: NDArray[np.int64]
    size: NDArray[np.int64]
    head: float

    @property
    def factors(self) -> Floats:
        """Pixels of the view per pixel of the picture, (2,)."""
        return np.array(self.pixels.shape[1::-1]) / self.size

    def place(self, points: Floats) -> Floats:
        """Pixels (k, 2) of the picture as pixels of the view."""
        return (points - self.corner + 0.5) * self.factors - 0.5

    def window(self) -> tuple[slice, slice]:
        """Rows and columns of the picture that the crop takes."""
        (x, y), (width, height) = self.corner, self.size
        return slice(y, y + height), slice(x, x + width)


def working_view(img: NDArray[np.uint8], head_points: Floats, side: float, margin: float = _MARGIN) -> WorkingView:
    """Crop a picture to a head and resize it, so that the head becomes ``side`` px large.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    head_points : (k, 2) float64, px
        Points all over the head.
    side : float, px
    margin : float
        What is kept on all sides, in sizes of the head.
    """
    low, high = head_points.min(axis=0), head_points.max(axis=0)
    extent = max(float((high - low).max()), 1.0)
    limit = np.array(img.shape[1::-1])
    start = np.clip(np.floor(low - margin * extent), 0, limit - 1).astype(np.int64)
    end = np.clip(np.ceil(high + margin * extent) + 1, start + 1, limit).astype(np.int64)
    size = end - start
    shape = np.maximum(np.rint(size * side / extent), 8).astype(int)
    crop = np.ascontiguousarray(img[start[1] : end[1], start[0] : end[0]])
    method = cv2.INTER_AREA if shape[0] < size[0] else cv2.INTER_CUBIC
    pixels = cv2.resize(crop, (int(shape[0]), int(shape[1])), interpolation=method)
    return WorkingView(np.asarray(pixels, np.uint8), start, size, side)
