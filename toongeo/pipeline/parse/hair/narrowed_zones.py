"""A skull that is not larger than the head that is drawn."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from toongeo.arrays import Floats, Mask, Singles
from toongeo.pipeline.parse.hair.head_zones import HeadZones

__all__ = ["narrowed_zones"]

# Chosen on CHOOSING of benchmarks/pictures.py, five of which have a drawn head far from the fitted one.
_HAIR = 0.04  # head sizes of hair, at least, between the skull and the outline of the head
_ABOVE = 0.05  # faces above the brows from which heads are compared: below are ears
_REST = 1.0, 0.5  # percent of the pixels beside and on top that are left out as stray
_FEWEST = 50  # px that tell an extent
_LEAST = 0.2, 0.25  # faces: breadth and height above the brows that a skull has at least


def narrowed_zones(zones: HeadZones, head: Mask) -> HeadZones:
    """Zones whose skull and ears are shifted and scaled into a head (h, w) bool that was cut out of the picture.

    Caricatures are drawn with crowns that the fitted head does not have. Where it reaches beyond the drawn one above
    the brows, there is ground that would be taken for crown. A head that is larger changes nothing: hair is thick.
    """
    fitted, drawn = _extent(zones, zones.skull), _extent(zones, head)
    if fitted is None or drawn is None:
        return zones
    face = 1 / float(np.hypot(*_gradient(zones.across)))
    hair = _HAIR * zones.head / face
    left, right = max(fitted[0], drawn[0] + hair), min(fitted[1], drawn[1] - hair)
    right = max(right, left + _LEAST[0])
    top = max(min(fitted[2], drawn[2] - hair), _LEAST[1])
    across = fitted[0] + (zones.across - left) * ((fitted[1] - fitted[0]) / (right - left))
    up = np.where(zones.up > 0, zones.up * (fitted[2] / top), zones.up)
    skull, ears = _moved(zones, across.astype(np.float32), up.astype(np.float32))
    return replace(zones, skull=skull, ears=ears & ~skull, crown=skull & zones.high)


def _extent(zones: HeadZones, mask: Mask) -> tuple[float, float, float] | None:
    """Where a mask ends above the brows: to the left, to the right, and above; in faces."""
    part = mask & (zones.up > _ABOVE)
    if part.sum() < _FEWEST:
        return None
    left, right = np.percentile(zones.across[part], [_REST[0], 100 - _REST[0]])
    return float(left), float(right), float(np.percentile(zones.up[part], 100 - _REST[1]))


def _gradient(field: Singles) -> Floats:
    """Of a field that is linear in x and y."""
    return np.array([field[0, 1] - field[0, 0], field[1, 0] - field[0, 0]], np.float64)


def _moved(zones: HeadZones, across: Singles, up: Singles) -> tuple[Mask, Mask]:
    """Skull and ears, looked up at other coordinates of the face."""
    height, width = across.shape
    y, x = np.mgrid[:height, :width].astype(np.float32)
    for now, then in ((zones.across, across), (zones.up, up)):
        slope = _gradient(now)
        step = (then - now) / np.float32(slope @ slope)
        x, y = x + step * np.float32(slope[0]), y + step * np.float32(slope[1])
    skull, ears = (
        cv2.remap(m.astype(np.uint8), x, y, cv2.INTER_NEAREST, borderMode=cv2.BORDER_REPLICATE) > 0
        for m in (zones.skull, zones.ears)
    )
    return np.asarray(skull, np.bool_), np.asarray(ears, np.bool_)
