"""The disc of an eye in the atlas, and what the picture shows of it."""

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np

from toongeo.arrays import Floats, Integers, Mask
from toongeo.model import EyeballTemplate
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig import Eyes
from toongeo.pipeline.texture.eyes.find_irises import Iris
from toongeo.pipeline.texture.face_picture import EYE_LEFT, EYE_RIGHT, MAX_SIDE, opening_mask
from toongeo.render import Fragments, rasterize, sample_image, uv_to_px

__all__ = ["EyeDisc", "eye_disc"]

_OUTLINE = 0.05  # of the eye's width: half the thickness of a drawn line
_GRAZING = 0.3  # cosine to the line of sight: nearer to the outline, a pixel covers too much of the eyeball


@dataclass(frozen=True, eq=False)
class EyeDisc:
    """The k texels of an eye's disc.

    Attributes
    ----------
    rows, columns : (k,) int64
        In the atlas.
    unit : (k, 3) float64
        On the unit sphere of the eyeball, whose pole +Z is the direction of gaze.
    colours : (k, 3) float64, sRGB, 0-255
        Of the picture where the texel falls in it.
    seen : (k,) bool
        Between the lids, and turned to the viewer.
    away : (k,) float64
        Distance from the middle of the iris in the picture, in its radii; infinite without one.
    angle : (k,) float64
        About it, radians.
    default : (k, 3) float64, sRGB, 0-255
        The model's own eye.
    iris : (k,) bool
        Within the model's iris.
    """

    rows: Integers
    columns: Integers
    unit: Floats
    colours: Floats
    seen: Mask
    away: Floats
    angle: Floats
    default: Floats
    iris: Mask


def eye_disc(img: np.ndarray, face: AlignedFace, eyes: Eyes, side: int, iris: Iris | None, size: int) -> EyeDisc:
    """The disc of eye 0 (left) or 1 (right) in an atlas of ``size`` texels, with the picture on it.

    A texel is seen if it projects between the lids, that is inside the smooth curves through the eye landmarks and
    not on the line that is drawn along them, with the eye turned as in the picture.
    """
    landmarks = face.project(face.vertices[face.landmark_vertices])
    rims = (EYE_LEFT, EYE_RIGHT)[side]
    crop, shift, scale = _eye_crop(img, landmarks[np.unique(np.concatenate(rims))])
    opening = _within_outline(opening_mask((landmarks - shift + 0.5) * scale - 0.5, rims, crop.shape[:2]))
    template = eyes.templates[side]
    disc = _fragments(template, size)
    rows, columns = np.nonzero(disc.mask)
    corners, weights = template.faces[disc.face_ids[disc.mask]], disc.barycentrics[disc.mask]
    turned = eyes.looking_as_drawn(side)
    px = face.project(turned)
    ahead = face.camera.view(turned - eyes.centres[side])[:, 2] / eyes.radii[side]
    values = np.column_stack([px, ahead, template.vertices, 255 * template.colour])
    at = np.einsum("kc,kcd->kd", weights, values[corners])
    in_crop = (at[:, :2] - shift + 0.5) * scale - 0.5
    column = np.clip(np.rint(in_crop[:, 0]), 0, crop.shape[1] - 1).astype(int)
    row = np.clip(np.rint(in_crop[:, 1]), 0, crop.shape[0] - 1).astype(int)
    front = at[:, 2] > _GRAZING
    away, angle = np.full(len(at), np.inf), np.zeros(len(at))
    if iris is not None:
        from_middle = (at[:, :2] - iris.centre) / iris.radii
        away[front] = np.linalg.norm(from_middle[front], axis=1)
        angle = np.arctan2(from_middle[:, 1], from_middle[:, 0])
    colours = sample_image(crop, in_crop).astype(float)
    unit, default = at[:, 3:6], at[:, 6:]
    within = unit[:, 2] > np.cos(template.iris_angle)
    return EyeDisc(rows, columns, unit, colours, opening[row, column] & front, away, angle, default, within)


def _within_outline(opening: np.ndarray) -> np.ndarray:
    """An opening (h, w) without the drawn line around it, which belongs to the lids."""
    width = 1 + 2 * round(_OUTLINE * np.ptp(np.nonzero(opening)[1])) if opening.any() else 1
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (width, width))
    eroded = cv2.erode(opening.astype(np.uint8), disc, borderType=cv2.BORDER_CONSTANT, borderValue=0)
    return eroded.astype(bool)


def _eye_crop(img: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """The picture about an eye, its corner in pixels of the picture, and its scale (reduced if very large)."""
    margin = 0.3 * np.ptp(points, axis=0).max() + 2
    bounds = np.array(img.shape[1::-1])
    start = np.clip(np.floor(points.min(0) - margin), 0, bounds - 1).astype(int)
    end = np.clip(np.ceil(points.max(0) + margin) + 1, start + 1, bounds).astype(int)
    crop = img[start[1] : end[1], start[0] : end[0]]
    scale = min(1.0, MAX_SIDE / 2 / max(crop.shape[:2]))
    if scale < 1:
        crop = cv2.resize(crop, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return np.ascontiguousarray(crop), start, scale


@lru_cache(maxsize=8)
def _fragments(template: EyeballTemplate, size: int) -> Fragments:
    return rasterize(uv_to_px(template.uv, size, size), template.faces, size, size)
