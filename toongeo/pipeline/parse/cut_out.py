"""GrabCut, from what is known, likely and unlikely.

Constants were chosen by eye on the seven examples and 15 caricatures.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Mask

__all__ = ["cut_out"]

_PASSES = 2
_FEWEST = 16  # px that either side needs for its five Gaussians


def cut_out(img: NDArray[np.uint8], *, sure: Mask, likely: Mask, never: Mask) -> Mask:
    """Foreground (h, w) bool by GrabCut (Rother et al. 2004).

    Parameters
    ----------
    img : (h, w, 3) uint8
        In any colour space.
    sure : (h, w) bool
        Certainly foreground.
    likely : (h, w) bool
        Foreground to begin with.
    never : (h, w) bool
        Certainly background, even where ``sure``.
    """
    mask = np.where(likely, cv2.GC_PR_FGD, cv2.GC_PR_BGD).astype(np.uint8)
    mask[sure] = cv2.GC_FGD
    mask[never] = cv2.GC_BGD
    front = (mask == cv2.GC_FGD) | (mask == cv2.GC_PR_FGD)
    if min(front.sum(), (~front).sum()) < _FEWEST:
        return front
    cv2.setRNGSeed(0)  # its k-means starts at random
    models = np.zeros((2, 1, 65), np.float64)
    cv2.grabCut(img, mask, (0, 0, 0, 0), models[0], models[1], _PASSES, cv2.GC_INIT_WITH_MASK)
    return (mask == cv2.GC_FGD) | (mask == cv2.GC_PR_FGD)
