"""Glasses before the eyes of a picture.

Constants were chosen on one half of the pictures, as they are and with rims drawn on them (``benchmarks/glasses.py``).
"""

from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Mask
from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.texture.glasses.rims import bridge, rim_below, sampled_at, thin_lines
from toongeo.pipeline.texture.glasses.upright_eyes import EyeView, upright_eyes

__all__ = ["Glasses", "find_glasses"]

# CIELAB lightness by which a rim is darker than what it lies on, over most of its way below an eye, and on the nose.
# Without glasses the 25 pictures have at most 10 and 6 together.
_RIM, _BRIDGE = 12.0, 6.0
# CIELAB: skin beside the lids differs so much from that of the cheek behind tinted glasses, if there is a bridge too.
_TINT, _TINTED_BRIDGE = 25.0, 8.0
_DARK = 0.55  # of the cheek's lightness: all that is about an eye is darker behind dark glasses
_LIT = 35.0  # lightness: of a face that lies in the dark, eyes are not told from glasses
_BROWS = np.r_[PARTS["brow_right"], PARTS["brow_left"]]
_GROWN = 0.04  # eye widths by which what was found is grown: rims have soft edges


@dataclass(frozen=True, eq=False)
class Glasses:
    """Glasses in a picture.

    Attributes
    ----------
    kind : {"clear", "dark"}
        Whether the eyes are seen behind them.
    cover : (H, W) bool
        Pixels of their frame, and if they are dark of the lenses.
    """

    kind: Literal["clear", "dark"]
    cover: Mask

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "cover")


def find_glasses(img: np.ndarray, landmarks: np.ndarray) -> Glasses | None:
    """Glasses that a face in a picture wears, or None.

    A frame is a thin dark line that runs smoothly below each eye, off the lid, and one across the nose between them.
    Dark glasses leave no light about either eye, or tint all of it, with a line or edge across the nose. Frames without
    rims, and such as are lighter than the skin, are not found.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
        With a NaN among the points of the eyes nothing is found.

    Returns
    -------
    Glasses or None
    """
    if not np.isfinite(landmarks[36:48]).all():
        return None
    view = upright_eyes(img, landmarks)
    lines = thin_lines(view)
    found = [rim_below(lines, eye) for eye in view.eyes]
    across, strengths = bridge(view)
    crossing = float(np.percentile(strengths, 50))
    if _is_dark(view, float(np.percentile(strengths, 20))):
        return Glasses("dark", _grown(view, view.back(_lenses(view), img.shape), 2 * _GROWN))
    if min(strength for _, strength in found) < _RIM or crossing < _BRIDGE:
        return None
    frame = _frame(view, lines, [*(path for path, _ in found), across])
    return Glasses("clear", _grown(view, view.back(frame, img.shape), _GROWN))


def _is_dark(view: EyeView, crossing: float) -> bool:
    """Whether what is about both eyes is another skin than the cheeks', or nearly black."""
    tinted, dark = [], []
    for eye in view.eyes:
        width, low = float(np.linalg.norm(eye[3] - eye[0])), eye[[4, 5], 1].mean()
        across = eye.mean(0)[0] + np.linspace(-0.4, 0.4, 17) * width
        near, cheek = (
            np.median(view.at(across, low + np.array(below) * width), axis=0)
            for below in ((0.1, 0.15, 0.2), (0.8, 0.95, 1.1))
        )
        tinted.append(np.linalg.norm(near - cheek) >= _TINT)
        about = view.lab[..., 0][view.inside(eye, 1.6)]
        lightest = np.percentile(about, 90) if len(about) else np.inf
        dark.append(cheek[0] >= _LIT and lightest < _DARK * cheek[0])
    return all(dark) or (all(tinted) and crossing >= _TINTED_BRIDGE)


def _lenses(view: EyeView) -> np.ndarray:
    """Mask of the view of both lenses and what joins them: pixels about the eyes that are not of the cheeks' skin."""
    cover = np.zeros(view.lab.shape[:2], bool)
    right, left = (eye.mean(0) for eye in view.eyes)
    reach, brows = 0.49 * float(np.linalg.norm(left - right)), view.points[_BROWS, 1].mean() + 4
    for eye in view.eyes:
        width, low = float(np.linalg.norm(eye[3] - eye[0])), eye[[4, 5], 1].mean()
        across = eye.mean(0)[0] + np.linspace(-0.4, 0.4, 17) * width
        cheek = np.median(view.at(across, low + np.array([0.8, 0.95, 1.1]) * width), axis=0)
        lens = np.median(view.at(across, low + np.array([0.1, 0.15, 0.2]) * width), axis=0)
        like_lens = np.linalg.norm(view.lab - cheek, axis=2) > 0.5 * np.linalg.norm(lens - cheek)
        rows, columns = np.indices(like_lens.shape)
        x, y = (columns - eye.mean(0)[0]) / width, (rows - eye.mean(0)[1]) / width
        near = like_lens & (np.abs(x) < reach / width) & (rows > brows) & (y < 1.0)
        near |= view.inside(eye, 1.3)
        near = cv2.morphologyEx(near.astype(np.uint8), cv2.MORPH_OPEN, np.ones((5, 5), np.uint8))
        _, labels = cv2.connectedComponents(near)
        own = labels == labels[tuple(np.clip(np.rint(eye.mean(0)[::-1]), 0, len(labels) - 1).astype(int))]
        outline, _ = cv2.findContours(own.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        hull = cv2.convexHull(np.vstack(outline))
        cover |= cv2.fillConvexPoly(np.zeros(cover.shape, np.uint8), hull, 1).astype(bool)
    return cover | (_frame(view, thin_lines(view, upright=True), [bridge(view)[0]]))


def _frame(view: EyeView, lines: np.ndarray, paths: list[np.ndarray]) -> np.ndarray:
    """Mask of the view of dark lines that hang together with paths, but not of lids and brows."""
    strength = np.median([np.median(sampled_at(lines, path[None])) for path in paths])
    line = lines > max(0.4 * float(strength), 4.0)
    spared = np.zeros(line.shape, np.uint8)
    for brow in ("brow_left", "brow_right"):
        cv2.polylines(spared, [np.rint(view.points[PARTS[brow]]).astype(np.int32)], False, 1, 14)
    for eye in view.eyes:
        spared |= view.inside(eye, 1.25).astype(np.uint8)
    width = float(np.mean([np.linalg.norm(eye[3] - eye[0]) for eye in view.eyes]))
    middle = view.points[36:48, 1].mean()
    height = np.arange(len(line))[:, None] - middle
    line &= (spared == 0) & (np.abs(height) < 1.1 * width)
    seeds = np.zeros(line.shape, np.uint8)
    cv2.polylines(seeds, [np.rint(path).astype(np.int32) for path in paths], False, 1, 3)
    _, labels = cv2.connectedComponents(line.astype(np.uint8), connectivity=8)
    return np.asarray(line & np.isin(labels, np.setdiff1d(np.unique(labels[seeds > 0]), 0)))


def _grown(view: EyeView, mask: np.ndarray, share: float) -> np.ndarray:
    width = 1 + 2 * max(1, round(share * view.eye_width))
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (width, width))
    return np.asarray(cv2.dilate(mask.astype(np.uint8), disc)).astype(bool)
