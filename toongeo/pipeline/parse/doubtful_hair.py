"""Hair for the labels where no mask of it is trusted: the mask as far as other cuts bear it out, or what they leave."""

from __future__ import annotations

import cv2
import numpy as np

from toongeo.arrays import Mask
from toongeo.pipeline.parse.colour_share import colour_codes, colour_share
from toongeo.pipeline.parse.face_zones import FaceZones
from toongeo.pipeline.parse.head_and_skin import HeadAndSkin
from toongeo.pipeline.parse.working_view import WorkingView

__all__ = ["doubtful_hair"]

# A cut that would take more than half of the mask contradicts it, and either may be wrong (a dark suit before a dark
# wall, white hair beside a pale face): then the mask stays.
_KEPT = 0.5
_FRAME = 0.02  # heads: a picture may have a drawn frame
_ALONG = 0.25  # heads: a tuft that the border cuts is narrower; the wall behind caricature 31 has 0.7
_COMMON = 0.01  # of the crown's pixels: so common is a colour of hair


def doubtful_hair(view: WorkingView, zones: FaceZones, cut: HeadAndSkin, mask: Mask) -> Mask:
    """Hair (h, w) bool of the working view from a mask that is not trusted, empty perhaps.

    An empty mask means that hair could not be told: then hair is what of the head above the chin is not skin.
    """
    if not mask.any():
        return _left(view, zones, cut.head & ~cut.skin)
    for other in (cut.head, ~cut.skin):
        both = mask & other
        mask = both if both.sum() > _KEPT * mask.sum() else mask
    return mask


def _left(view: WorkingView, zones: FaceZones, left: Mask) -> Mask:
    """Of a mask, all above the chin that is beside the face, and within the face what has its colours.

    Nothing below the chin: what is left there are clothes more often than hair. Nothing that runs along the picture's
    border, either: there the cut of the head has let the ground in, and a wall is no hair.
    """
    crown = _within(left & ~zones.below_chin & ~zones.hull, view.head)
    common = colour_share(colour_codes(view.pixels), crown) > _COMMON
    return np.asarray(crown | (left & zones.hull & common))


def _within(mask: Mask, head: float) -> Mask:
    """A mask (h, w) less the pieces that meet the border of the view along much of the head's size."""
    count, pieces = cv2.connectedComponents(mask.astype(np.uint8), connectivity=4)
    inner = np.zeros(mask.shape, bool)
    frame = max(1, round(_FRAME * head))
    inner[frame:-frame, frame:-frame] = True
    met = np.bincount(pieces[~inner], minlength=count) / frame > _ALONG * head
    met[0] = False
    return mask & ~met[pieces]
