"""The hair of a mask on the raster of the plane, without specks and whole where the picture's border cuts it."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.hair.plane.masks import closed, depth_inside, dilated, large_pieces, opened, without_holes
from toongeo.pipeline.hair.plane.working_plane import CELL_MM, WorkingPlane

__all__ = ["HairRaster", "hair_raster"]

_THIN_MM = 1.5  # half the breadth of the thinnest strand: a thinner one is a drawn line
_TIP_MM = 6.0  # how far from thicker hair a thinner tip may reach
_SPECK = 0.02  # of the largest piece's cells
_NEAR_MM = 15.0  # farther from the head a piece is no hair of it
_PINHOLE_MM2 = 40.0  # a hole in a mask below this is noise; above, background that shows between strands
_HELD_MM = (4.0, 30.0)  # thickness of hair where the border hides it, measured beside the crown
_CUT = 0.25  # of the crown's breadth: hair that meets the border along more goes on beyond it


@dataclass(frozen=True, eq=False)
class HairRaster:
    """``hair``: cells of hair; ``pictured``: cells within the picture, both (rows, columns) bool."""

    hair: NDArray[np.bool_]
    pictured: NDArray[np.bool_]


def hair_raster(plane: WorkingPlane, mask: NDArray[np.bool_], crown: NDArray[np.bool_]) -> HairRaster:
    """Cells of a mask (H, W) of the picture; ``crown`` (rows, columns) is the silhouette of the scalp.

    Lines and specks are dropped. Where the border of the picture cuts the hair above the ears, it goes on at an even
    thickness over the crown.
    """
    pixels = plane.scale * CELL_MM
    soft = cv2.GaussianBlur(mask.astype(np.float32), (0, 0), max(0.6, 0.4 * pixels))  # no cell falls between pixels
    hair = plane.warp(soft) > 0.5
    pictured = plane.warp(np.ones(mask.shape, np.uint8), nearest=True) > 0
    thick = opened(hair, _THIN_MM)
    hair &= dilated(thick, _TIP_MM)
    hair = without_holes(hair, _PINHOLE_MM2)
    hair = large_pieces(hair & _near(hair, crown), _SPECK) if hair.any() else hair
    cut = (hair & dilated(~pictured, 2 * CELL_MM)).any(0)
    if cut.sum() > _CUT * crown.any(0).sum() > 0:
        hair = _completed(hair, pictured, crown)
    return HairRaster(hair, pictured)


def _near(hair: NDArray[np.bool_], crown: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells of pieces that come near the crown."""
    _, pieces = cv2.connectedComponents(hair.astype(np.uint8), connectivity=4)
    touched = np.unique(pieces[hair & dilated(crown, _NEAR_MM)])
    return np.asarray(np.isin(pieces, touched[touched > 0]))


def _completed(hair: NDArray[np.bool_], pictured: NDArray[np.bool_], crown: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Hair that goes on beyond the picture's border, over the crown, as thick as beside it."""
    beyond = depth_inside(~crown)
    rows = np.flatnonzero(crown.any(1))
    beside = hair & ~crown & pictured
    beside[: rows[len(rows) // 2]] = False
    thickness = float(np.clip(np.percentile(beyond[beside], 90) if beside.any() else 0.0, *_HELD_MM))
    whole = hair | (~pictured & (beyond <= thickness))
    return hair | (closed(whole, 6.0) & ~pictured)
