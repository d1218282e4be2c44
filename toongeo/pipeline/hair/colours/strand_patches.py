"""Pieces of the hair of a picture, turned so that their strands run down."""

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, map_coordinates

from toongeo.arrays import Reals
from toongeo.pipeline.hair.colours.picture_colours import PictureColours

__all__ = ["strand_patches"]


_MOST = 60  # patches: more look no more varied
_SIDE_MM = (10.0, 36.0)  # of a patch: a lock of hair, as far as the hair is broad enough
_FLOW_MM = 8.0  # over which the direction of strands is smoothed
_OUTSTANDING = 2.0  # times the usual contrast
_STEADY = 0.15  # coherence below which a patch is taken as it stands
_LENGTH_MM = 2.5  # along strands patches are smoothed: curls and grain of a photograph are specks where they repeat


def strand_patches(colours: PictureColours, per_mm: float, rng: np.random.Generator) -> NDArray[np.float32]:
    """Patches (k, b, b, 3) of what strands add to the broad colours, rows along them."""
    deep = np.where(colours.known, colours.inside, 0.0)
    side = float(np.clip(1.4 * np.percentile(deep[colours.known], 90), *_SIDE_MM))
    pixels = max(6, round(side * per_mm))
    # As far inside as most of a patch needs, or as the hair allows.
    rows, columns = np.nonzero(deep >= min(0.6 * side, 0.7 * float(deep.max())))
    chosen = rng.permutation(len(rows))[:_MOST]
    centres = np.column_stack([rows[chosen], columns[chosen]]).astype(np.float64)
    down = _strand_directions(colours)[rows[chosen], columns[chosen]]
    detail = colours.drawn - colours.broad
    steps = (np.arange(pixels) - (pixels - 1) / 2) / per_mm / colours.cell_mm
    across = np.column_stack([-down[:, 1], down[:, 0]])
    # A row of the patch is a step down the strands, a column one across them.
    at = centres[:, None, None] + steps[:, None, None] * down[:, None, None] + steps[:, None] * across[:, None, None]
    places = np.moveaxis(at, 3, 0).reshape(2, -1)
    channels = [map_coordinates(detail[..., k], places, order=1, mode="nearest") for k in range(3)]
    patches = np.stack(channels, 1).reshape(len(centres), pixels, pixels, 3).astype(np.float32)
    # Smoothed along the strands, and as strong as before.
    before = patches.std((1, 2), keepdims=True)
    patches = gaussian_filter1d(patches, _LENGTH_MM * per_mm, axis=1, mode="nearest")
    patches *= before / np.maximum(patches.std((1, 2), keepdims=True), 1e-3 + 0.5 * before)
    # A stroke that few patches have is drawn where it belongs, not a pattern of the hair.
    contrast = patches.std((1, 2, 3))
    return patches[contrast <= _OUTSTANDING * np.median(contrast)]


def _strand_directions(colours: PictureColours) -> Reals:
    """Unit vectors (h, w, 2), row and column, along the strands; down the picture, where they say nothing else.

    Across strands the colour changes most: the structure tensor (Foerstner and Guelch 1987).
    """
    light = cv2.cvtColor(colours.drawn / np.float32(255), cv2.COLOR_RGB2GRAY)
    light = cv2.GaussianBlur(light, (0, 0), 0.7)
    dx, dy = cv2.Sobel(light, cv2.CV_32F, 1, 0), cv2.Sobel(light, cv2.CV_32F, 0, 1)
    inner = (colours.inside > 2.0).astype(np.float32)  # not the outline itself
    sigma = _FLOW_MM / colours.cell_mm
    xx, yy, xy = (cv2.GaussianBlur(product * inner, (0, 0), sigma) for product in (dx * dx, dy * dy, dx * dy))
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)  # of the gradient, from the columns' axis
    coherence = np.hypot(xx - yy, 2 * xy) / np.maximum(xx + yy, 1e-9)
    along = np.stack([np.cos(angle), -np.sin(angle)], -1)
    along = np.where(along[..., :1] > 0, -along, along)  # rows of the plane run up
    return np.where(coherence[..., None] > _STEADY, along, np.array([-1.0, 0.0]))
