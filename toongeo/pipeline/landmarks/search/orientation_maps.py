"""Where the grey levels of a picture rise, and in which direction."""

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["DIRECTIONS", "orientation_maps"]

DIRECTIONS = 8
_SHARPNESS = np.cos(2 * np.pi / DIRECTIONS)  # a direction counts for its two neighbours at most, as in a histogram
_ANGLES = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
_LOBES = np.stack([np.cos(_ANGLES), np.sin(_ANGLES), np.full(DIRECTIONS, -_SHARPNESS)], axis=1).astype(np.float32)
_LOBES /= np.float32(1 - _SHARPNESS)
_SOBEL = 1 / 4  # grey levels a px


def orientation_maps(grey: NDArray[np.uint8], cell: int, blur: float) -> tuple[NDArray[np.float32], ...]:
    """Gradient strength by direction, averaged over cells: two arrays (h // cell, w // cell, 4) float32.

    A gradient g counts for the direction d with ``max(0, g.d - |g| cos 45) / (1 - cos 45)``: nearly the soft
    histogram of N. Dalal, B. Triggs (CVPR 2005) at a fraction of its cost.

    Parameters
    ----------
    grey : (h, w) uint8
    cell : int
        Side of a cell in px; h and w are its multiples.
    blur : float
        Standard deviation in px of the blur before.
    """
    smooth = cv2.GaussianBlur(grey, (0, 0), blur)
    across = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=_SOBEL)
    down = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=_SOBEL)
    slopes = cv2.merge([across, down, cv2.magnitude(across, down)])
    size = grey.shape[1] // cell, grey.shape[0] // cell
    maps = []
    for half in (_LOBES[:4], _LOBES[4:]):  # OpenCV takes four channels at a time
        strength = cv2.transform(slopes, half)
        np.maximum(strength, 0, out=strength)
        maps.append(cv2.resize(strength, size, interpolation=cv2.INTER_AREA))
    return tuple(maps)
