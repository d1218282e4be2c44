"""What the shell's sheets must know of head and hair, as rasters, and at points."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import grey_erosion

from toongeo.arrays import Mask
from toongeo.pipeline.hair.plane.depth_maps import ball_offset
from toongeo.pipeline.hair.plane.masks import nearest_set, signed
from toongeo.pipeline.hair.plane.working_plane import WorkingPlane
from toongeo.pipeline.hair.shell.regions import CLEAR_MM, HeadRaster, Regions

__all__ = ["SheetMaps", "SheetRasters"]

Floats = NDArray[np.floating]

_WIDE_MM = 5.0  # ball that rolls over the skin where the hairline runs: it bridges the steep side of the cheeks
_RAISED_MM = 2.0  # of that ball's surface, after it was lowered again
_UNDER_MM = 2.0  # below the skin a surface does not show
_THICK_MM = (3.0, 14.0)  # of hair on the scalp
_FAR_MM = 1e4
_FALL = 8.0  # slope with which the head falls off beside its silhouette


@dataclass(frozen=True, eq=False)
class SheetMaps:
    """Depths (n,) in mm at points: of a smoothed skin, of the back of the skin, of what is hidden under the skin, and
    those that the hair's front is not below and its back not before; and which points lie on the head, and between
    hanging strands."""

    on_skin: Floats
    behind_skin: Floats
    under: Floats
    front_floor: Floats
    back_floor: Floats
    on_head: Mask
    hanging: Mask


@dataclass(frozen=True, eq=False)
class SheetRasters:
    """The plane with the regions of the hair and the head under it."""

    plane: WorkingPlane
    parts: Regions
    head: HeadRaster

    def at(self, P: Floats) -> SheetMaps:
        """The maps at plane points (n, 2)."""
        depths = {name: self.plane.sample(raster, P) for name, raster in self._depths.items()}
        hanging, crown = (self.plane.sample(raster, P) for raster in self._distances[3:])
        on_head = self.plane.sample(self._aired.astype(np.float64), P) > 0.5
        return SheetMaps(**depths, on_head=on_head, hanging=(hanging > -2.5) & (crown < -2.5))

    def shown(self, centres: Floats) -> tuple[Mask, Mask]:
        """Triangles (m,), by their centres, whose front and whose back is seen; each at least on one side."""
        whole, front, back = (self.plane.sample(raster, centres) for raster in self._distances[:3])
        first, second = ((inside > 0) | ((inside > -1.5) & (whole < 2.5)) for inside in (front, back))
        return first, second | ~first

    @cached_property
    def thickness(self) -> float:
        """mm of hair on the scalp: half of what the picture shows above it."""
        tops = (np.flatnonzero(mask.any(1))[-1] for mask in (self.parts.front, self.head.crown))
        hair, crown = (self.plane.points(np.array([0.0, row]))[1] for row in tops)
        return float(np.clip((hair - crown) / 2, *_THICK_MM))

    @cached_property
    def _depths(self) -> dict[str, Floats]:
        head = self.head
        rolled = ball_offset(head.front, _WIDE_MM) - (_WIDE_MM - _RAISED_MM)
        low = grey_erosion(np.where(head.head, head.front, np.inf), size=(5, 5))
        return {
            "on_skin": nearest_set(rolled, np.isfinite(rolled)),
            "behind_skin": nearest_set(head.back_off, np.isfinite(head.back_off)),
            "under": nearest_set(low, np.isfinite(low) & head.head) - _UNDER_MM,
            "front_floor": _falling(self._front_off, self._aired, -1),
            "back_floor": _falling(head.back_off, np.isfinite(head.back_off), 1),
        }

    @cached_property
    def _front_off(self) -> Floats:
        """The front of the skin that hair lies on, with air; -inf elsewhere."""
        return ball_offset(np.where(self.parts.over_skin, self.head.front, -np.inf), CLEAR_MM)

    @cached_property
    def _aired(self) -> Mask:
        return np.isfinite(self._front_off)

    @cached_property
    def _distances(self) -> list[Floats]:
        parts = self.parts
        return [signed(mask) for mask in (parts.whole, parts.front, parts.back, parts.hanging, self.head.crown)]


def _falling(depth: Floats, known: Mask, side: int) -> Floats:
    """A depth map that falls off steeply beside the head; far away where there is none."""
    if not known.any():
        return np.full(depth.shape, side * _FAR_MM)
    return np.asarray(nearest_set(depth, known) + side * _FALL * np.maximum(-signed(known), 0))
