"""What strands add to the colour of hair that no picture shows."""

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.hair.colours.picture_colours import PictureColours
from toongeo.pipeline.hair.colours.quilted import quilted
from toongeo.pipeline.hair.colours.strand_patches import strand_patches

__all__ = ["strands"]

_OVERLAP = 0.3  # of a patch's side


def strands(colours: PictureColours, size_mm: tuple[float, float], per_mm: float) -> NDArray[np.float32]:
    """Differences of colour (rows, columns, 3), strands running down, of so many mm along and across them.

    The strands of the picture go on: its own patches, turned along the flow and quilted. The same picture gives the
    same strands.
    """
    rng = np.random.default_rng(0)
    patches = strand_patches(colours, per_mm, rng)
    shape = (round(size_mm[0] * per_mm), round(size_mm[1] * per_mm))
    return quilted(patches, shape, max(2, round(_OVERLAP * patches.shape[1])), rng)
