"""Is it a photograph, or a painting like one, rather than a drawing?"""

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.pipeline.landmarks.search.detector_file import shipped_detector
from toongeo.pipeline.landmarks.search.find_faces import looks

__all__ = ["looks_photographed"]


# How flat (see `flat_look`: half-way between where the detector takes its parts for photographs and where it does not),
# and how much like a figure.
_FLAT, _FIGURE = 0.45, 0.0


def looks_photographed(img: NDArray[np.uint8], points: Floats) -> bool:
    """Whether the face at points (68, 2) px of a picture (H, W, 3) looks more like a photograph than like a drawing.

    By how flat its colours are, and how much its features look like those of figures, which the detector learned on
    renders. A painting with shades and textures looks like a photograph.
    """
    flat, figure = looks(cv2.cvtColor(img, cv2.COLOR_RGB2GRAY), points, shipped_detector())
    return flat < _FLAT and figure < _FIGURE
