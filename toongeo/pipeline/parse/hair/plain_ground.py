"""Ground that is one smooth tone: paper, studio walls, flat paint."""

from __future__ import annotations

import cv2
import numpy as np

from toongeo.pipeline.parse.hair.head_zones import HeadZones
from toongeo.pipeline.parse.masks import Mask, grown
from toongeo.pipeline.parse.working_view import WorkingView

__all__ = ["plain_ground"]

_STEP = 2  # levels, 0-255, between neighbours
_SMOOTH = (5, 12, 3)  # of the bilateral filter: diameter px, levels, px
_CLEAR = 0.05  # head sizes: so far from the fitted head the flood may begin
_LEAST = 0.12  # of the view that must be reached


def plain_ground(view: WorkingView, zones: HeadZones) -> Mask | None:
    """Pixels (h, w) reached from the view's upper, left and right border over tiny steps; None if they are few."""
    height, width = zones.skull.shape
    smooth = cv2.bilateralFilter(view.pixels, *_SMOOTH)
    reached = np.zeros((height + 2, width + 2), np.uint8)
    close = grown(zones.skull, _CLEAR * zones.head) | (zones.up < -1)
    flags = 4 | (1 << 8) | cv2.FLOODFILL_MASK_ONLY
    for x, y in [(x, 0) for x in range(width)] + [(x, y) for y in range(height) for x in (0, width - 1)]:
        if not close[y, x] and not reached[y + 1, x + 1]:
            cv2.floodFill(smooth, reached, (x, y), 0, (_STEP,) * 3, (_STEP,) * 3, flags)
    ground = reached[1:-1, 1:-1] > 0
    return ground if ground.mean() > _LEAST else None
