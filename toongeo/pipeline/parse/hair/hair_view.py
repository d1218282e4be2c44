"""The part of a picture in which hair is looked for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.parse.working_view import WorkingView, working_view
from toongeo.protocols import FittedFace

__all__ = ["HEAD_PX", "hair_view"]

HEAD_PX = 180.0  # px: strands of a few millimetres are a pixel then, and all of it takes half a second
_MARGIN = 0.75  # head sizes around the fitted head; longer hair is cut off


def hair_view(img: NDArray[np.uint8], fit: FittedFace, head_px: float = HEAD_PX) -> WorkingView:
    """A picture (H, W, 3) about its fitted head, which becomes 180 px large unless another size is asked for."""
    head = fit.vertices[fit.region("skin") | fit.region("scalp")]
    return working_view(img, fit.camera.project(head), head_px, _MARGIN)
