"""Whether there are irises in the eyes, lips at the mouth, and skin between."""

import numpy as np

from toongeo.arrays import Floats
from toongeo.pipeline.landmarks.evidence.upright_crop import EYES, UprightCrop

__all__ = ["COLOUR_CUES", "colour_cues"]

COLOUR_CUES = "irises", "lips", "skin"
_AROUND = 1.4, 2.2  # the ring about an eye, in its own size
_DARK = 15  # percent of an eye's pixels that are as dark as its iris, at least
_SAME = 12.0  # CIELAB; skin in one light
_LIGHTS = 5.0  # CIELAB; added to the spread of a face, which may be drawn in one colour


def colour_cues(crop: UprightCrop) -> Floats:
    """(3,) How much darker the eyes are than what is around them and how far the lips' colour is from the skin's, in
    spreads of the face's lightness; and which share of the skin has nearly one colour."""
    skin = crop.lab[crop.skin()]
    if len(skin) == 0:
        return np.zeros(3)
    median = np.median(skin, axis=0)
    spread = float(crop.lab[crop.face()][:, 0].std()) + _LIGHTS
    eyes = np.mean([_darker(crop, rows) for rows in EYES])
    lips = crop.lab[crop.lips()]
    red = float(np.linalg.norm(np.median(lips, axis=0) - median)) if len(lips) else 0.0
    same = float((np.linalg.norm(skin - median, axis=1) < _SAME).mean())
    return np.array([eyes / spread, red / spread, same])


def _darker(crop: UprightCrop, rows: np.ndarray) -> float:
    """How much darker the darkest part of an eye is than the ring around it."""
    inside, around = crop.inside(rows), crop.inside(rows, _AROUND[1]) & ~crop.inside(rows, _AROUND[0])
    if not (inside.any() and around.any()):
        return 0.0
    light = crop.lab[..., 0]
    return float(np.median(light[around]) - np.percentile(light[inside], _DARK))
