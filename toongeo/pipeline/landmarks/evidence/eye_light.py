"""Whether the eyes are dark to well beyond their lids, as behind dark glasses."""

import numpy as np

from toongeo.arrays import Floats
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.pipeline.landmarks.evidence.upright_crop import EYES, UprightCrop
from toongeo.pipeline.landmarks.search.detector_file import shipped_detector

__all__ = ["are_dark", "light_about_eyes"]

# Chosen on 75 renders with dark glasses drawn on them and 600 as they are, with the points that were found.
_REACH = 0.17  # of the mean face's outer-eye distance: half an eye, and as much above and below as a lens covers
_LIGHTEST = 80  # percentile: points of hidden eyes lie beside the lens as often as on it
_DARK = 0.35  # of the skin's lightness: 79 % of those with dark glasses are below, and 3 of the others


def light_about_eyes(crop: UprightCrop) -> Floats:
    """(2,) How light what lies about the middles of right and left eye is, nearly all of it, as a share of the skin's
    lightness."""
    skin = crop.skin()
    if not skin.any():
        return np.ones(2)
    return np.array([_lightness(crop, crop.points[rows].mean(0)) for rows in EYES]) / max(
        np.median(crop.lab[skin][:, 0]), 1.0
    )


def are_dark(eye_light: Floats) -> bool:
    """Whether both eyes (2,) of :func:`light_about_eyes` are."""
    return bool((eye_light < _DARK).all())


def _lightness(crop: UprightCrop, middle: Floats) -> float:
    outer = shipped_detector().cascade.shape[list(OUTER_EYES)]
    reach = _REACH * np.linalg.norm(outer[1] - outer[0])
    y, x = np.indices(crop.lab.shape[:2])
    inside = (x - middle[0]) ** 2 + (y - middle[1]) ** 2 < reach**2
    return float(np.percentile(crop.lab[inside][:, 0], _LIGHTEST)) if inside.any() else np.inf
