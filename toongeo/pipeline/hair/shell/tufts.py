"""The lower edge of hair that no picture shows."""

import numpy as np

from toongeo.arrays import Mask
from toongeo.pipeline.hair.plane.masks import depth_inside
from toongeo.pipeline.hair.plane.working_plane import CELL_MM

__all__ = ["between_tufts"]

# mm: breadths and depths of tufts. Those of locks: narrower ones look gnawed. The two repeat together only after 0.6 m.
_BREADTH_MM, _DEPTH_MM = (19.0, 31.0), (5.0, 6.0)
_SLOPE = 0.5  # by which they get deeper away from strands that hang lower, so that corners are round


def between_tufts(hair: Mask, other: Mask) -> Mask:
    """Cells (rows, columns) bool between the tufts of a lower edge, upwards from the lowest cell of each column.

    Rows go up. Hair that is cut off along a line looks like a board. Columns in which ``other`` hangs lower stay.
    """
    rows, across = np.arange(hair.shape[0])[:, None], np.arange(hair.shape[1]) * CELL_MM
    lowest = np.where(hair.any(axis=0), hair.argmax(axis=0), len(hair))
    free = np.asarray(hair.any(axis=0) & ~(other & (rows < lowest)).any(axis=0))
    up = sum((d * 2 * np.abs((across / b) % 1 - 0.5) for b, d in zip(_BREADTH_MM, _DEPTH_MM, strict=True)), 0.0)
    up = np.minimum(up, _SLOPE * depth_inside(free[None])[0])
    return hair & ((rows - lowest) * CELL_MM < up)
