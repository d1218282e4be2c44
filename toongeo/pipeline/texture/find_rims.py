"""Rims of glasses as lines, dark or light."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo.arrays import Floats
from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.texture.glasses.rims import bridge, rim_above, rim_below, thin_lines
from toongeo.pipeline.texture.glasses.upright_eyes import upright_eyes

__all__ = ["Rims", "find_rims"]

# CIELAB lightness by which a rim differs from what it lies on, over most of its way below an eye, and on the nose; and
# above the eye. Without glasses 48 renders, portraits and examples have at most 3.5 below, or no bridge; faint rims in
# the portraits and renders have 8 and 5.9.
_BELOW, _BRIDGE, _ABOVE = 6.0, 4.5, 4.0


@dataclass(frozen=True, eq=False)
class Rims:
    """Rims of a pair of glasses.

    Attributes
    ----------
    lines : tuple of (k, 2) float, px
        Below the right and the left eye, across the nose, and above the eyes where they are seen.
    light : bool
        Whether they are lighter than the skin.
    """

    lines: tuple[Floats, ...]
    light: bool

    __repr__ = brief_repr


def find_rims(img: np.ndarray, landmarks: Floats) -> Rims | None:
    """Where the rims of glasses run in a picture, faint and light ones too, or None without any.

    What is found may be drawn; to take glasses off a picture :func:`find_glasses` asks for more.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
    """
    view = upright_eyes(img, landmarks)
    for light in (False, True):
        lines = thin_lines(view, light=light)
        below = [rim_below(lines, eye) for eye in view.eyes]
        across, strengths = bridge(view, light)
        if min(strength for _, strength in below) < _BELOW or np.median(strengths) < _BRIDGE:
            continue
        brows = (view.points[PARTS["brow_right"]], view.points[PARTS["brow_left"]])
        above = [rim_above(lines, eye, brow) for eye, brow in zip(view.eyes, brows, strict=True)]
        found = [*(path for path, _ in below), across, *(path for path, strength in above if strength > _ABOVE)]
        inverse = cv2.invertAffineTransform(view.matrix)
        return Rims(tuple(np.asarray(path @ inverse[:, :2].T + inverse[:, 2], np.float64) for path in found), light)
    return None
