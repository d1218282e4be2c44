"""A picture without the glasses in it."""

import cv2
import numpy as np

from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.texture.face_picture import EYE_LEFT, EYE_RIGHT, opening_mask
from toongeo.pipeline.texture.find_glasses import Glasses
from toongeo.protocols import FaceLabel, FaceParse

__all__ = ["without_glasses"]

_NO_SKIN = FaceLabel.HAIR, FaceLabel.HAT, FaceLabel.BROW_LEFT, FaceLabel.BROW_RIGHT, FaceLabel.BACKGROUND
_WHITE, _IRIS, _PUPIL, _LASH = (238, 234, 228), (92, 64, 44), (18, 14, 12), 0.35  # sRGB; the last of the skin
_RADIUS, _PUPIL_SHARE = 0.24, 0.45  # of the eye's width, and of the iris
_FINE = 4  # subpixels a side
_SURE = 8.0  # a mean of an eighth of the pixels of its neighbourhood is as good as of all


def without_glasses(
    img: np.ndarray, landmarks: np.ndarray, glasses: Glasses, parse: FaceParse | None = None
) -> np.ndarray:
    """The picture with what glasses cover filled from around, and with eyes where dark ones hide them.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
    glasses : Glasses
        From :func:`~toongeo.pipeline.texture.find_glasses.find_glasses`.
    parse : FaceParse, optional
        What it calls hair, hat, brow or background lends nothing.

    Returns
    -------
    (H, W, 3) uint8 RGB
        The eyes that are made up are brown and look ahead; only their outline is of the picture.
    """
    eyes = [opening_mask(landmarks, rims, img.shape[:2]) for rims in (EYE_RIGHT, EYE_LEFT)]
    cover = glasses.cover.copy()
    if glasses.kind == "clear":
        cover &= ~(eyes[0] | eyes[1])
    # Not the soft edge of the frame, which would veil what is filled.
    lends = cv2.dilate(cover.astype(np.uint8), np.ones((5, 5), np.uint8)) == 0
    if parse is not None:
        lends &= ~parse.mask(*_NO_SKIN)
    filled = _filled(img, cover, lends)
    if glasses.kind == "dark":
        for name, opening in zip(("eye_right", "eye_left"), eyes, strict=True):
            filled = _with_eye(filled, landmarks[PARTS[name]], opening)
    return filled


def _filled(img: np.ndarray, cover: np.ndarray, lends: np.ndarray) -> np.ndarray:
    """Covered pixels take the means of what lends around them, at the finest scale at which something does."""
    known = lends.astype(np.float32)[..., None]
    levels = [np.concatenate([img * known, known], axis=2).astype(np.float32)]
    while min(levels[-1].shape[:2]) > 1:
        levels.append(np.asarray(cv2.pyrDown(levels[-1]), np.float32))
    colours = levels[-1][..., :3] / np.maximum(levels[-1][..., 3:], 1e-3)
    for level in reversed(levels[:-1]):
        coarse = np.asarray(cv2.pyrUp(colours, dstsize=level.shape[1::-1]))
        share = np.minimum(_SURE * level[..., 3:], 1)
        colours = level[..., :3] / np.maximum(level[..., 3:], 1e-3) * share + coarse * (1 - share)
    return np.where(cover[..., None], np.clip(np.rint(colours), 0, 255), img).astype(np.uint8)


def _with_eye(img: np.ndarray, eye: np.ndarray, opening: np.ndarray) -> np.ndarray:
    """A picture with an open eye within its outline (6, 2) px, whose pixels are ``opening`` (H, W)."""
    if not opening.any():
        return img
    rows, columns = (np.flatnonzero(opening.any(axis)) for axis in (1, 0))
    box = slice(max(rows[0] - 2, 0), rows[-1] + 3), slice(max(columns[0] - 2, 0), columns[-1] + 3)
    corner, width = np.array([box[1].start, box[0].start]), float(np.linalg.norm(eye[3] - eye[0]))
    size = img[box].shape[1] * _FINE, img[box].shape[0] * _FINE
    drawn = np.full((*size[::-1], 3), _WHITE, np.uint8)
    middle = tuple(int(v) for v in np.rint((eye.mean(0) - corner + 0.5) * _FINE))
    for radius, colour in ((_RADIUS, _IRIS), (_PUPIL_SHARE * _RADIUS, _PUPIL)):
        cv2.circle(drawn, middle, max(1, round(radius * width * _FINE)), colour, -1)
    skin = np.median(img[box][~opening[box]], axis=0) if (~opening[box]).any() else np.array(_WHITE)
    upper = np.rint((eye[:4] - corner + 0.5) * _FINE).astype(np.int32)
    cv2.polylines(drawn, [upper], False, [int(_LASH * v) for v in skin], max(1, round(0.05 * width * _FINE)))
    small = cv2.resize(drawn, img[box].shape[1::-1], interpolation=cv2.INTER_AREA).astype(np.float32)
    share = cv2.GaussianBlur(opening[box].astype(np.float32), (0, 0), 0.7)[..., None]
    out = img.copy()
    out[box] = np.clip(np.rint(img[box] + share * (small - img[box])), 0, 255).astype(np.uint8)
    return out
