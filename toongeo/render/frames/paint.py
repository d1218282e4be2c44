"""Colours of pixels whose place in the atlas and light are known."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Mask, Singles
from toongeo.colour.srgb import linear_to_srgb

__all__ = ["encoded", "planes_on", "shaded"]

# Between black and the next colour there are 20 of these steps; elsewhere there are more.
_ENCODED = np.rint(255 * linear_to_srgb(np.arange(2**16) / (2**16 - 1))).astype(np.uint8)


def planes_on(ground: Singles, values: Singles, nothing: Mask) -> list[Singles]:
    """The channels (h, w) of values (h, w, c), which are ``ground`` (c,) where there is ``nothing`` (h, w)."""
    planes = [np.asarray(plane, np.float32) for plane in cv2.split(values)]
    for plane, value in zip(planes, ground, strict=True):
        np.copyto(plane, value, where=nothing)
    return planes


def shaded(atlas: Singles, planes: Sequence[Singles]) -> Singles:
    """Linear colours (h, w, 3), w < 2^15: of the atlas, to 1/32 of a texel, times light.

    Planes (h, w) are the texel's x and y and the light: one for all colours, or red, green, blue, and others.
    """
    x, y, *light = planes
    colours = cv2.remap(atlas, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(cv2.multiply(colours, cv2.merge((light * 3)[:3])), np.float32)


def encoded(linear: Singles) -> NDArray[np.uint8]:
    """sRGB of linear light >= 0, by a table whose steps are finer than those of the result."""
    most = np.float32(len(_ENCODED) - 1)
    steps = linear * most
    steps += np.float32(0.5)
    return _ENCODED.take(np.minimum(steps, most, out=steps).astype(np.uint16))
