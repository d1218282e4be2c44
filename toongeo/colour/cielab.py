"""Colours in which distances mean something."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["cielab"]


def cielab(pixels: NDArray[np.uint8]) -> NDArray[np.float32]:
    """CIELAB (h, w, 3) of a picture (h, w, 3) uint8 RGB: L in 0..100, a and b about -100..100."""
    return np.asarray(cv2.cvtColor(pixels.astype(np.float32) / 255, cv2.COLOR_RGB2LAB), np.float32)
