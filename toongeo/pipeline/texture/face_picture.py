"""The part of the picture that shows the face, and which of its pixels are skin.

Constants were chosen on the seven examples, whose painted backgrounds must not come through.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from scipy.interpolate import CubicSpline

from toongeo.geometry.polyline import arc_length
from toongeo.model.ibug68 import LID_RIMS, LIP_RIMS
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.texture.skin_mask import amid, resized, skin_mask, skin_weight
from toongeo.protocols import FaceLabel, FaceParse
from toongeo.render import Fragments, rasterize

__all__ = ["EYE_LEFT", "EYE_RIGHT", "FacePicture", "MAX_SIDE", "OPENINGS", "face_picture", "opening_mask"]

MAX_SIDE = 1024  # px; a larger crop is reduced, which also filters it before it is sampled
_RIM = 0.012  # of the face's width: by how much the silhouette is eroded
_FEATHER = 0.04  # of the face's width: over this distance from the rim of the skin its trust grows to 1
_FRONTAL = 0.2  # cosine to the viewing direction below which a surface is too oblique to be trusted
# Upper and lower rim of each opening.
EYE_RIGHT, EYE_LEFT = ((LID_RIMS[f"lid_upper_{side}"], LID_RIMS[f"lid_lower_{side}"]) for side in ("right", "left"))
_MOUTH = LIP_RIMS["lip_upper_inner"], LIP_RIMS["lip_lower_inner"]
OPENINGS = (EYE_RIGHT, EYE_LEFT, _MOUTH)


@dataclass(frozen=True, eq=False)
class FacePicture:
    """A crop of the picture with the face projected into it.

    Attributes
    ----------
    pixels : (h, w, 3) uint8 RGB
    points : (n, 2) float64
        Where each vertex falls, in pixels of the crop (Pan et al. 2024, Eq. 12, not normalized).
    cosines : (n,) float64
        Between vertex normal and direction to the viewer.
    fragments : Fragments
        The face rasterized into the crop.
    skin : (h, w) bool
        Pixels that show the face; background, hair, eyes and open mouth are out.
    sure : (h, w) bool
        Among them those that have the colour of its skin: no outlines, brows or lips.
    openings : (h, w) bool
        Pixels between the lips and, if the model has eyeballs behind them, between the lids.
    weight : (h, w) float32
        How far a pixel is to be believed: 0 outside the skin, growing inwards, times the confidence of the parse.
    hair : (h, w) bool or None
        Pixels parsed as hair; None without a parse.
    scale : float
        Pixels of the crop per pixel of the picture.
    origin : (2,) float64
        Pixel of the picture at the corner of the crop.
    """

    pixels: np.ndarray
    points: np.ndarray
    cosines: np.ndarray
    fragments: Fragments
    skin: np.ndarray
    sure: np.ndarray
    openings: np.ndarray
    weight: np.ndarray
    hair: np.ndarray | None
    scale: float
    origin: np.ndarray

    def place(self, px: np.ndarray) -> np.ndarray:
        """Pixels of the picture (k, 2) as pixels of the crop."""
        return (px - self.origin + 0.5) * self.scale - 0.5


def face_picture(img: np.ndarray, face: AlignedFace, parse: FaceParse | None = None) -> FacePicture:
    """Crop a picture to the projected face and find the skin in it.

    Skin is where the front of the face projects, less the eyes and the open mouth. Beyond the hull of the landmarks
    (forehead, temples), where hair and background may cover the face, a parse must call it skin, or the colour must be
    that of the skin.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    face : AlignedFace
    parse : FaceParse, optional
        Then only what it calls face is skin, and what it calls background has no say in what colour skin is.

    Returns
    -------
    FacePicture

    Raises
    ------
    ValueError
        If the parse is of another size than the picture.
    """
    if parse is not None and parse.labels.shape != img.shape[:2]:
        raise ValueError(f"parse: expected labels of the picture's shape {img.shape[:2]}, got {parse.labels.shape}")
    px = face.project(face.vertices)
    low, high = px[face.region("face")].min(0), px[face.region("face")].max(0)
    margin = 0.1 * (high - low).max()
    bounds = np.array(img.shape[1::-1])
    start = np.clip(np.floor(low - margin), 0, bounds - 1).astype(int)
    end = np.clip(np.ceil(high + margin) + 1, start + 1, bounds).astype(int)
    crop = img[start[1] : end[1], start[0] : end[0]]
    scale = min(1.0, MAX_SIDE / max(crop.shape[:2]))
    if scale < 1:
        crop = cv2.resize(crop, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    points = (px - start + 0.5) * scale - 0.5
    depth = face.camera.depth(face.vertices)
    fragments = rasterize(np.column_stack([points, depth]), face.faces, *crop.shape[:2])
    cosines = face.camera.view(face.normals + face.vertices)[:, 2] - face.camera.view(face.vertices)[:, 2]
    landmarks = points[face.landmark_vertices]
    openings = np.zeros(crop.shape[:2], bool)
    for rims in OPENINGS if face.model.has("eyes") else (_MOUTH,):  # without eyeballs the skin itself shows the eyes
        openings |= opening_mask(landmarks, rims, crop.shape[:2])
    front = _front_pixels(face, fragments, cosines) & ~openings
    box = slice(start[1], end[1]), slice(start[0], end[0])
    parts = None if parse is None else resized(parse.labels[box], crop.shape, cv2.INTER_NEAREST)
    width = float(np.ptp(landmarks[:, 0]))
    skin, sure = skin_mask(crop, landmarks, front, parts, max(1, round(_RIM * width)))
    weight = skin_weight(skin, openings, _FEATHER * width)
    if parse is not None:
        # Amid the face a parser may doubt whether it sees lip or skin, but not whether it sees the face.
        confidence = np.clip(2 * resized(parse.confidence[box], crop.shape, cv2.INTER_AREA), 0, 1)
        weight *= np.maximum(confidence, cv2.GaussianBlur(amid(landmarks, front.shape), (0, 0), max(1.0, _RIM * width)))
    hair = None if parts is None else parts == FaceLabel.HAIR
    return FacePicture(
        np.ascontiguousarray(crop), points, cosines, fragments, skin, sure, openings, weight, hair, scale, start
    )


def opening_mask(
    landmarks: np.ndarray, rims: tuple[tuple[int, ...], tuple[int, ...]], shape: tuple[int, int]
) -> np.ndarray:
    """Pixels (h, w) bool between two rims, each a smooth curve through its landmarks (68, 2)."""
    upper, lower = (_curve(landmarks[list(rim)]) for rim in rims)
    polygon = np.vstack([upper, lower[::-1]])
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.round(polygon * 16).astype(np.int32)], 1, shift=4)
    return mask.astype(bool)


def _curve(points: np.ndarray, samples: int = 24) -> np.ndarray:
    length = arc_length(points, least=1e-9)
    return CubicSpline(length, points)(np.linspace(0, length[-1], samples))


def _front_pixels(face: AlignedFace, fragments: Fragments, cosines: np.ndarray) -> np.ndarray:
    """Pixels covered by triangles of the region ``face`` that look towards the camera."""
    wanted = (face.region("face")[face.faces].all(1)) & (cosines[face.faces].mean(1) > _FRONTAL)
    return fragments.mask & wanted[fragments.face_ids]
