"""How common colours are in one part of a picture.

Constants were chosen by eye on the seven examples and 15 caricatures.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

__all__ = ["ColourCodes", "colour_codes", "colour_share"]

ColourCodes = NDArray[np.intp]

_LEVELS = 16  # a channel
_BLUR = 0.7  # levels


def colour_codes(img: NDArray[np.uint8]) -> ColourCodes:
    """Number (h, w) of the cell in a 16³ grid that each colour (h, w, 3) falls in."""
    level = (img // (256 // _LEVELS)).astype(np.intp)
    return (level[..., 0] * _LEVELS + level[..., 1]) * _LEVELS + level[..., 2]


def colour_share(codes: ColourCodes, part: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Share (h, w) that each pixel's colour, and those next to it, have in a part; 0 everywhere if it is empty."""
    counts = np.bincount(codes[part], minlength=_LEVELS**3).reshape(_LEVELS, _LEVELS, _LEVELS)
    blurred = gaussian_filter(counts / max(int(part.sum()), 1), _BLUR, mode="nearest")
    return blurred.ravel()[codes]
