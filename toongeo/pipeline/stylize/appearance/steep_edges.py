"""Edges as sharp as a drawing's."""

import cv2
import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.stylize.appearance.pixels import blurred

__all__ = ["border_line", "steep_edges"]

_STEEP = 4.0  # slope of the step between the local extremes
_SOFT = 0.7  # px; of the result, against stairs
_FLAT = np.float32(2e-3)  # a mask that changes by less a pixel has no border there


def steep_edges(picture: Singles, radius: int) -> Singles:
    """Each pixel takes the nearer of the extremes around it (toggle contrast, Kramer and Bruckner 1975).

    Parameters
    ----------
    picture : (h, w, c) float32
    radius : int, px
        Half the side of the square in which extremes are looked for.
    """
    square = cv2.getStructuringElement(cv2.MORPH_RECT, (2 * radius + 1,) * 2)
    low, high = cv2.erode(picture, square), cv2.dilate(picture, square)
    share = np.clip((picture - low) / np.maximum(high - low, np.float32(1e-3)), 0, 1)
    share = 0.5 + 0.5 * np.tanh(_STEEP * (share - 0.5)) / np.float32(np.tanh(_STEEP / 2))
    return blurred(np.asarray(low + share * (high - low), np.float32), _SOFT)


def border_line(mask: Singles, half_width: float) -> Singles:
    """Cover (h, w) of a line along the level 0.5 of a soft mask; half its width in px."""
    slope = np.hypot(cv2.Sobel(mask, cv2.CV_32F, 1, 0), cv2.Sobel(mask, cv2.CV_32F, 0, 1)) / 8
    distance = np.abs(mask - 0.5) / np.maximum(slope, np.float32(1e-3))
    return np.asarray(np.clip(half_width + 0.5 - distance, 0, 1) * (slope > _FLAT), np.float32)
