"""Where OpenCV's perspective camera sees points of a picture."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats, Singles

__all__ = ["opencv_space"]


def opencv_space(points: Floats, distance: Floats, height: int, width: int) -> Singles:
    """Points (n, 3) that the camera of fovY = pi/2 sees at the pixels of ``points`` and at a distance (n,), in 1..2.

    X = x_ndc d w/h, Y = y_ndc d, Z = -d undoes its perspective. OpenCV's pixel centres are at +0.5.
    """
    space = np.empty((len(points), 3), np.float32)
    space[:, 0] = ((points[:, 0] + 0.5) * (2.0 / width) - 1.0) * distance * (width / height)
    space[:, 1] = (1.0 - (points[:, 1] + 0.5) * (2.0 / height)) * distance
    space[:, 2] = -distance
    return space
