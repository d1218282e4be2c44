"""The hair of a mask on the raster of the plane, without specks and whole where the picture's border cuts it."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Mask
from toongeo.pipeline.hair.plane.masks import dilated, large_pieces, opened, without_holes
from toongeo.pipeline.hair.plane.working_plane import CELL_MM, WorkingPlane

__all__ = ["HairRaster", "hair_raster"]


_THIN_MM = 1.5  # half the breadth of the thinnest strand: a thinner one is a drawn line
_TIP_MM = 6.0  # how far from thicker hair a thinner tip may reach
_SPECK = 0.02  # of the largest piece's cells
_NEAR_MM = 15.0  # farther from the head a piece is no hair of it
_PINHOLE_MM2 = 40.0  # a hole in a mask below this is noise; above, background that shows between strands
_SLOPE_MM = 10.0  # below the border: so high a band tells how the hair meets it
_OVER_CROWN_MM, _LEAST_MM = 8.0, 2.0  # hair where the border hides it: at most over the crown, at least over the border
_CUT = 0.25  # of the crown's breadth: hair that meets the border along more goes on beyond it


@dataclass(frozen=True, eq=False)
class HairRaster:
    """``hair``: cells of hair; ``pictured``: cells within the picture, both (rows, columns) bool."""

    hair: Mask
    pictured: Mask


def hair_raster(plane: WorkingPlane, mask: Mask, crown: Mask) -> HairRaster:
    """Cells of a mask (H, W) of the picture; ``crown`` (rows, columns) is the silhouette of the scalp.

    Lines and specks are dropped. Where the upper border of the picture cuts the hair, it is completed by an arc.
    """
    pixels = plane.scale * CELL_MM
    soft = cv2.GaussianBlur(mask.astype(np.float32), (0, 0), max(0.6, 0.4 * pixels))  # no cell falls between pixels
    hair = plane.warp(soft) > 0.5
    pictured = plane.warp(np.ones(mask.shape, np.uint8), nearest=True) > 0
    thick = opened(hair, _THIN_MM)
    hair &= dilated(thick, _TIP_MM)
    hair = without_holes(hair, _PINHOLE_MM2)
    hair = large_pieces(hair & _near(hair, crown), _SPECK) if hair.any() else hair
    above = ~pictured & (np.arange(len(hair))[:, None] > len(hair) // 2)
    cut = (hair & dilated(above, CELL_MM)).any(0)
    if cut.sum() > _CUT * crown.any(0).sum() > 0:
        hair = _completed(hair, pictured, crown)
    return HairRaster(hair, pictured)


def _near(hair: Mask, crown: Mask) -> Mask:
    """Cells of pieces that come near the crown."""
    _, pieces = cv2.connectedComponents(hair.astype(np.uint8), connectivity=4)
    touched = np.unique(pieces[hair & dilated(crown, _NEAR_MM)])
    return np.asarray(np.isin(pieces, touched[touched > 0]))


def _completed(hair: Mask, pictured: Mask, crown: Mask) -> Mask:
    """Hair that goes on above the picture's upper border, as an arc that leaves the border as the hair meets it.

    It is no higher than hair of some thickness over the crown.
    """
    top = int(np.flatnonzero(pictured.any(1))[-1])
    while top > 0 and not hair[top].any():
        top -= 1
    columns = np.flatnonzero(hair[top])
    left, right = columns[0], columns[-1]
    lower = max(0, top - round(_SLOPE_MM / CELL_MM))
    below = np.flatnonzero(hair[lower]) if hair[lower].any() else columns
    half = (right - left + 1) / 2
    steep = np.arctan2(top - lower, max(((left - below[0]) + (below[-1] - right)) / 2, 0.0))
    crown_top = int(np.flatnonzero(crown.any(1))[-1])
    highest = max(crown_top + _OVER_CROWN_MM / CELL_MM - top, _LEAST_MM / CELL_MM)
    rise = float(np.clip(half * np.tan(steep / 2), _LEAST_MM / CELL_MM, highest))
    row, column = np.mgrid[: hair.shape[0], : hair.shape[1]]
    arc = ((column - (left + right) / 2) / half) ** 2 + ((row - top) / rise) ** 2 <= 1
    return hair | (arc & (row >= top) & ~pictured)
