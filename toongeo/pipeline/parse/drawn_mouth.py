"""Teeth and tongue in an open mouth of a picture.

Constants: see ``benchmarks/mouths.py``.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from skimage.filters import threshold_otsu

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.colour.cielab import cielab
from toongeo.protocols import FaceLabel, FaceParse

__all__ = ["DrawnMouth", "drawn_mouth"]

_RIM = 0.012  # of the mouth's width: a drawn outline, and what lips throw a shadow on
_FEWEST = 40  # pixels; a smaller opening shows nothing
_CONTRAST = 14.0  # CIELAB: of teeth to what is beside them; with less, all of the opening is one thing
_TEETH = (15.0, 13.0, 45.0)  # most red (a*) of a tooth's pixel and of their median, least lightness of that
_TONGUE = (12.0, 35.0)  # least red and lightness of a tongue
_CLOSING = 0.02  # of the mouth's width: lines between teeth are narrower


@dataclass(frozen=True, eq=False)
class DrawnMouth:
    """What an open mouth shows.

    Attributes
    ----------
    inside, teeth, tongue : (H, W) bool
        Pixels between the lips, without their rims, and of teeth and tongue among them.
    width : float, px
        Of the mouth.
    """

    inside: np.ndarray
    teeth: np.ndarray
    tongue: np.ndarray
    width: float

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "inside", "teeth", "tongue")


def drawn_mouth(img: np.ndarray, parse: FaceParse) -> DrawnMouth | None:
    """Find teeth and tongue between the lips: teeth are the light class of two, hardly red; a tongue is red.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    parse : FaceParse
        Of the same picture.

    Returns
    -------
    DrawnMouth or None
        None if the mouth is closed.

    Examples
    --------
    >>> img = np.full((60, 90, 3), (60, 10, 10), np.uint8)
    >>> img[20:30, 20:70] = 250
    >>> labels = np.zeros((60, 90), np.uint8)
    >>> labels[18:50, 18:72] = FaceLabel.INNER_MOUTH
    >>> mouth = drawn_mouth(img, FaceParse(labels, np.ones((60, 90))))
    >>> bool(mouth.teeth[25, 40]), bool(mouth.teeth[40, 40])
    (True, False)
    """
    opening = parse.mask(FaceLabel.INNER_MOUTH)
    rows, columns = np.nonzero(opening)
    if len(rows) < _FEWEST:
        return None
    width = float(np.ptp(columns)) + 1
    box = np.s_[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
    inside = np.zeros_like(opening)
    size = 2 * max(1, round(_RIM * width)) + 1
    padded = cv2.erode(np.pad(opening[box], 1).astype(np.uint8), np.ones((size, size), np.uint8))
    inside[box] = padded[1:-1, 1:-1] > 0
    if np.count_nonzero(inside) < _FEWEST:
        return None
    lab = cielab(img[box])
    within = inside[box]
    teeth, tongue = np.zeros_like(opening), np.zeros_like(opening)
    teeth[box] = _teeth(lab, within, width)
    tongue[box] = within & ~teeth[box] & (lab[..., 1] > _TONGUE[0]) & (lab[..., 0] > _TONGUE[1])
    return DrawnMouth(inside, teeth, tongue, width)


def _teeth(lab: np.ndarray, within: np.ndarray, width: float) -> np.ndarray:
    lightness, red = lab[..., 0], lab[..., 1]
    white = lightness - 0.8 * np.hypot(red, lab[..., 2] / 2)
    values = white[within]
    limit = threshold_otsu(values) if np.ptp(values) > 0 else values[0]
    light = values > limit
    if light.any() and values[light].mean() - values[~light].mean() >= _CONTRAST:
        teeth = within & (white > limit) & (red < _TEETH[0])
    else:
        teeth = within & bool(np.median(values) > _TEETH[2])
    if not teeth.any() or np.median(red[teeth]) > _TEETH[1] or np.median(lightness[teeth]) < _TEETH[2]:
        return np.zeros_like(within)
    disc = np.ones((max(3, int(_CLOSING * width)),) * 2, np.uint8)
    return np.asarray((cv2.morphologyEx(teeth.astype(np.uint8), cv2.MORPH_CLOSE, disc) > 0) & within)
