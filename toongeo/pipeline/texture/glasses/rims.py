"""Where rims of glasses run, if there are any."""

import cv2
import numpy as np

from toongeo.arrays import Floats
from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.texture.glasses.smooth_path import smooth_path
from toongeo.pipeline.texture.glasses.upright_eyes import EyeView

__all__ = ["bridge", "rim_above", "rim_below", "sampled_at", "thin_lines"]

_LINE = 17  # px of the view: rims are thinner
_BELOW = np.radians(np.linspace(15, 165, 61))  # where a rim is looked for, from the eye's middle, downwards
_RADII = np.linspace(0.5, 1.15, 53)  # eye widths
_OFF_LID = 0.18  # eye widths from the lower lid: nearer lie lashes and bags
_OFF_UPPER, _OFF_BROW = 0.25, 0.12  # eye widths from the upper lid and the brow
_MOST = 30  # percent of a rim's way that may be fainter than told


def thin_lines(view: EyeView, upright: bool = False, light: bool = False) -> np.ndarray:
    """How much darker (or lighter) each pixel of a view is than what is on both sides of a thin line through it.

    With ``upright`` only lines across count, as on the bridge of the nose.
    """
    shape = np.ones((_LINE, 1), np.uint8) if upright else cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (_LINE, _LINE))
    lightness = cv2.GaussianBlur(view.lab[..., 0], (0, 0), 1.0)
    if light:
        lightness = -lightness
    return np.asarray(cv2.morphologyEx(lightness, cv2.MORPH_CLOSE, shape) - lightness, np.float32)


def rim_below(lines: np.ndarray, eye: Floats) -> tuple[Floats, float]:
    """The likeliest rim (61, 2) below an eye (6, 2), and how strong most of it is."""
    middle, width = eye.mean(0), float(np.linalg.norm(eye[3] - eye[0]))
    places = _fan(middle, width, 1.0)
    strength = sampled_at(lines, places)
    down, lid = places[..., 1] - middle[1], eye[[4, 5], 1].mean() - middle[1]
    strength[(down < lid + _OFF_LID * width) & (np.sin(_BELOW)[:, None] > 0.35)] = 0
    return _way(places, strength)


def rim_above(lines: np.ndarray, eye: Floats, brow: Floats) -> tuple[Floats, float]:
    """The likeliest rim (61, 2) above an eye (6, 2), off the lid and the brow (5, 2), and how strong most of it is."""
    middle, width = eye.mean(0), float(np.linalg.norm(eye[3] - eye[0]))
    places = _fan(middle, width, -1.0)
    strength = sampled_at(lines, places)
    up, lid = middle[1] - places[..., 1], middle[1] - eye[[1, 2], 1].mean()
    strength[(up < lid + _OFF_UPPER * width) & (np.sin(_BELOW)[:, None] > 0.35)] = 0
    off = np.abs(places[..., None, :] - brow).max(axis=-1).min(axis=-1)
    strength[off < _OFF_BROW * width] = 0
    return _way(places, strength)


def bridge(view: EyeView, light: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """The likeliest line (41, 2) across the nose between the eyes, and how strong it is along its way (41,)."""
    lines = thin_lines(view, upright=True, light=light)
    left, right = view.points[PARTS["eye_right"][3]], view.points[PARTS["eye_left"][0]]
    width, span = np.linalg.norm(left - view.points[PARTS["eye_right"][0]]), right[0] - left[0]
    x = np.linspace(left[0] + 0.12 * span, right[0] - 0.12 * span, 41)
    y = (left[1] + right[1]) / 2 + np.linspace(-0.55, 0.45, 41) * width
    places = np.dstack(np.meshgrid(x, y, indexing="ij"))
    strength = sampled_at(lines, places)
    way = smooth_path(strength)
    return places[np.arange(41), way], strength[np.arange(41), way]


def sampled_at(image: np.ndarray, places: np.ndarray) -> np.ndarray:
    """A picture at places (..., 2), between its pixels."""
    x, y = (np.ascontiguousarray(places[..., k], np.float32) for k in (0, 1))
    return np.asarray(cv2.remap(image, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE))


def _fan(middle: Floats, width: float, down: float) -> Floats:
    """Places (61, 53, 2) on rays from the middle of an eye."""
    x = np.cos(_BELOW)[:, None] * (_RADII * width)
    return np.asarray(np.dstack([middle[0] + x, middle[1] + down * np.sin(_BELOW)[:, None] * (_RADII * width)]))


def _way(places: Floats, strength: np.ndarray) -> tuple[Floats, float]:
    way, rows = smooth_path(strength), np.arange(len(strength))
    return places[rows, way], float(np.percentile(strength[rows, way], _MOST))
