"""What strands add to the colour of hair that no picture shows."""

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.hair.colours.picture_colours import PictureColours

__all__ = ["strands"]

_LONG = 420  # mm along the strands: from the whorl to the waist


def strands(colours: PictureColours, radius: float) -> NDArray[np.float32]:
    """Differences of colour (along, across, 3), a row and a column a mm, periodic across."""
    across = max(8, round(2 * np.pi * radius))
    rng = np.random.default_rng(0)
    noise = np.asarray(rng.standard_normal((_LONG // 4, across)), np.float32)
    smooth = cv2.GaussianBlur(np.hstack([noise] * 3), (0, 0), sigmaX=0.6, sigmaY=4.0)[:, across : 2 * across]
    fine = cv2.resize(smooth, (across, _LONG), interpolation=cv2.INTER_LINEAR)
    deep = colours.known & (colours.inside > 4)
    deep = deep if deep.any() else colours.known
    rest = (colours.drawn - colours.broad)[deep]
    contrast = np.clip(1.25 * np.median(np.abs(rest.mean(1))), 0, 25)
    return np.asarray(np.repeat((fine / fine.std() * contrast)[..., None], 3, 2), np.float32)
