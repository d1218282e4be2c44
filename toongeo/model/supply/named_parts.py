"""What a morphable model from elsewhere does not bring along, derived from its mean and landmarks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from toongeo.model.ibug68 import PARTS

__all__ = ["named_parts"]

_MARGIN_MM = 8.0  # around a part's landmarks
_PARTS = {"eye_left": ("eye_left",), "eye_right": ("eye_right",), "mouth": ("mouth",), "nose": ("nose",)}


def named_parts(mean: NDArray[np.float64], landmarks: NDArray[np.int64]) -> dict[str, NDArray[np.bool_]]:
    """Masks (n,) of eyes, nose and mouth: all within 8 mm of the landmarks of a part."""
    masks = {}
    for name, parts in _PARTS.items():
        points = mean[landmarks[np.concatenate([PARTS[part] for part in parts])]]
        masks[name] = cKDTree(points).query(mean)[0] < _MARGIN_MM
    return masks
