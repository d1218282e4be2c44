"""Where in a frame one sample a pixel is not enough."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats, Integers, Mask, Singles

__all__ = ["edge_pixels", "faces_near"]

_STEEP = 4.0  # px of depth from one pixel to the next: a slope of 76 degrees, where a surface turns away or ends
_FAR = 6.0  # texels from one pixel to the next, which are about one apart: another place of the head begins


def edge_pixels(x: Singles, y: Singles, depth: Singles, px: float) -> Mask:
    """Pixels (h, w) from which another is far: in the texture, in depth, or because nothing is there.

    ``x`` and ``y`` (h, w) are texels; of the depth (h, w), in any unit, ``px`` is as much as a pixel is wide.
    """
    edges = np.zeros(x.shape, bool)
    for values, apart in ((x, _FAR), (y, _FAR), (depth, _STEEP * px)):
        across = np.abs(values[:, 1:] - values[:, :-1]) > apart
        down = np.abs(values[1:] - values[:-1]) > apart
        edges[:, 1:] |= across
        edges[:, :-1] |= across
        edges[1:] |= down
        edges[:-1] |= down
    return edges


def faces_near(px: Floats, faces: NDArray[np.integer], edges: Mask) -> Integers:
    """Rows of the faces (m, 3) in whose bounding box there is a pixel of ``edges`` (h, w)."""
    height, width = edges.shape
    count = np.zeros((height + 1, width + 1), np.int32)
    count[1:, 1:] = cv2.integral(edges.astype(np.uint8))[1:, 1:]
    x, y = (np.clip(np.rint(px[:, axis]), -1, side).astype(np.int32) for axis, side in ((0, width), (1, height)))
    a, b, c = faces.T
    left, right = (function(function(x[a], x[b]), x[c]) for function in (np.minimum, np.maximum))
    top, bottom = (function(function(y[a], y[b]), y[c]) for function in (np.minimum, np.maximum))
    left, top = np.maximum(left, 0), np.maximum(top, 0)
    right, bottom = np.minimum(right + 1, width), np.minimum(bottom + 1, height)
    # Beyond the picture left > right: what then stands here is not used.
    inside = (left < right) & (top < bottom)
    left, right, top, bottom = (edge * inside for edge in (left, right, top, bottom))
    above, below = top * (width + 1), bottom * (width + 1)
    upper_left, upper_right, lower_left, lower_right = (
        count.take(line + column) for line in (above, below) for column in (left, right)
    )
    return np.flatnonzero(lower_right - upper_right - lower_left + upper_left)
