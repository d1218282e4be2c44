"""Where the origin of a head is."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["eye_origin"]

EYE_DEPTH_MM = 13.0  # from the corners of an eye back to its centre
_CORNERS = (36, 39, 42, 45)  # of the eyes


def eye_origin(V: NDArray[np.float64], landmarks: NDArray[np.int64], unit: float) -> NDArray[np.float64]:
    """Midpoint of the eyeballs in the frame of the vertices: 13 mm behind the middle of the corners of the eyes.

    A model without landmarks keeps its height and depth; its origin is the middle of its bounding box.
    """
    if not landmarks.size:
        return np.asarray((V.min(axis=0) + V.max(axis=0)) / 2)
    return np.asarray(V[landmarks[list(_CORNERS)]].mean(axis=0) - [0.0, 0.0, EYE_DEPTH_MM / unit])
