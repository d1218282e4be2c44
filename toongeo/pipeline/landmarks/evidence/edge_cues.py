"""Whether edges of the picture run along lids, lips and jaw."""

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.geometry.polyline import arc_length, interpolated
from toongeo.model.ibug68 import LID_RIMS, LIP_RIMS, PARTS
from toongeo.pipeline.landmarks.evidence.upright_crop import UprightCrop

__all__ = ["EDGE_CUES", "edge_cues"]

_CURVES = {
    "lids": tuple(map(list, LID_RIMS.values())),
    "lips": tuple(map(list, LIP_RIMS.values())),
    "jaw": (PARTS["jaw"].tolist(),),
}
EDGE_CUES = tuple(_CURVES)
_BLUR_PX, _STEP_PX = 1.0, 1.0
_REACH_PX, _NEAR_PX = 8, 1  # of the crop: how far to each side is looked, and what is on the curve
_FLOOR = 0.5  # of lightness a pixel: less is no edge


def edge_cues(crop: UprightCrop) -> Floats:
    """(3,) For lids, lips and jaw: log of how much stronger the edges along them are than those beside them.

    An edge is how much the lightness changes across the curve, whichever way. Curves moved to either side are what it
    is compared with, so that a picture full of edges says no more than a soft one.
    """
    light = cv2.GaussianBlur(crop.lab[..., 0], (0, 0), _BLUR_PX)
    gradient = np.stack(np.gradient(light)[::-1], axis=-1)
    return np.array([_contrast(gradient, [crop.points[rows] for rows in curves]) for curves in _CURVES.values()])


def _contrast(gradient: NDArray[np.float32], curves: list[Floats]) -> float:
    offsets = np.arange(-_REACH_PX, _REACH_PX + 1)
    steps = np.concatenate([_across(gradient, path, offsets) for path in curves])
    along = steps[:, np.abs(offsets) <= _NEAR_PX].mean()
    return float(np.log((along + _FLOOR) / (steps.mean() + _FLOOR)))


def _across(gradient: NDArray[np.float32], path: Floats, offsets: NDArray[np.int64]) -> Floats:
    """Change of lightness (k, o) across a path, at places along it and on curves beside it."""
    length = arc_length(path, least=1e-6)
    places = interpolated(np.arange(0, length[-1], _STEP_PX), length, path)
    tangents = np.gradient(places, axis=0) if len(places) > 1 else np.array([[1.0, 0.0]])
    normals = np.stack([-tangents[:, 1], tangents[:, 0]], -1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-9
    at = (places[:, None] + offsets[:, None] * normals[:, None]).astype(np.float32)
    sampled = cv2.remap(gradient, at[..., 0], at[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return np.abs(np.einsum("koc,kc->ko", sampled, normals))
