"""How much a face looks like a flat drawing."""

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.search.face_crop import face_crop
from toongeo.pipeline.landmarks.search.frames import similarity_onto

__all__ = ["flat_look"]

_LINES = 0.1  # of the pixels: about what outlines and features cover
_MARGIN_PX = 30  # of the crop that is mostly background


def flat_look(grey: np.ndarray, points: NDArray[np.float64], shape: NDArray[np.float64]) -> float:
    """The share in [0.1, 1] of all steps between neighbouring pixels that the strongest tenth of them holds.

    Near 1 of clean lines between flat colours, a half of photographs. The picture (h, w) is looked at where its points
    (68, 2) align with the mean shape.

    Examples
    --------
    >>> from toongeo.pipeline.landmarks.search.face_crop import CROP_PX
    >>> shape = np.random.default_rng(0).normal(CROP_PX / 2, 27, (68, 2))
    >>> y, x = np.mgrid[:CROP_PX, :CROP_PX]
    >>> ramp, step = np.uint8(x + y // 2), np.uint8(200 * (x > CROP_PX / 2))
    >>> [round(flat_look(grey, shape, shape), 1) for grey in (ramp, step)]
    [0.1, 1.0]
    """
    crop = face_crop(grey, similarity_onto(points, shape))[_MARGIN_PX:-_MARGIN_PX, _MARGIN_PX:-_MARGIN_PX]
    across, down = (cv2.Sobel(crop, cv2.CV_32F, *order) for order in ((1, 0), (0, 1)))
    steps = np.sort((np.abs(across) + np.abs(down)).ravel())
    total = float(steps.sum())
    return float(steps[-int(_LINES * len(steps)) :].sum()) / total if total else 1.0
