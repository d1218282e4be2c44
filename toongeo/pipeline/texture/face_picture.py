"""The part of the picture that shows the face, and which of its pixels are skin."""

from dataclasses import dataclass

import cv2
import numpy as np
from scipy.interpolate import CubicSpline

from toongeo.model.ibug68 import LID_RIMS, LIP_RIMS, PARTS
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.render import Fragments, rasterize

MAX_SIDE = 1024  # px; a larger crop is reduced, which also filters it before it is sampled
SPREAD = (
    7.0,
    13.0,
)  # CIELAB units: least and largest distance from the skin's colour that still counts as skin
FRONTAL = 0.2  # cosine to the viewing direction below which a surface is too oblique to be trusted
# Upper and lower rim of each opening.
EYE_RIGHT, EYE_LEFT = ((LID_RIMS[f"lid_upper_{side}"], LID_RIMS[f"lid_lower_{side}"]) for side in ("right", "left"))
MOUTH = LIP_RIMS["lip_upper_inner"], LIP_RIMS["lip_lower_inner"]
OPENINGS = (EYE_RIGHT, EYE_LEFT, MOUTH)
# Chin, nose, eye and mouth corners: within their hull there is no hair.
CORE = np.r_[PARTS["jaw"][4:13], PARTS["nose"], 36, 39, 42, 45, 48, 54]


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
        Pixels between the lids and between the lips.
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
    scale: float
    origin: np.ndarray

    def place(self, px: np.ndarray) -> np.ndarray:
        """Pixels of the picture (k, 2) as pixels of the crop."""
        return (px - self.origin + 0.5) * self.scale - 0.5


def face_picture(img: np.ndarray, face: AlignedFace) -> FacePicture:
    """Crop a picture to the projected face and find the skin in it.

    Skin is where the front of the face projects, less the eyes and the open mouth. Beyond the hull of the landmarks
    (forehead, temples), where hair and background may cover the face, the colour must also be that of the skin.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    face : AlignedFace

    Returns
    -------
    FacePicture
    """
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
    for rims in OPENINGS:
        openings |= opening_mask(landmarks, rims, crop.shape[:2])
    front = _front_pixels(face, fragments, cosines) & ~openings
    skin, sure = _skin_pixels(crop, landmarks, front)
    return FacePicture(np.ascontiguousarray(crop), points, cosines, fragments, skin, sure, openings, scale, start)


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
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1) + 1e-9)]
    return CubicSpline(length, points)(np.linspace(0, length[-1], samples))


def _front_pixels(face: AlignedFace, fragments: Fragments, cosines: np.ndarray) -> np.ndarray:
    """Pixels covered by triangles of the region ``face`` that look towards the camera."""
    wanted = (face.region("face")[face.faces].all(1)) & (cosines[face.faces].mean(1) > FRONTAL)
    return fragments.mask & wanted[fragments.face_ids]


def _skin_tones(lab: np.ndarray, core: np.ndarray) -> np.ndarray:
    """Colours (4, 3) of skin from shadow to light: the mean about each of four levels of lightness in the core."""
    pixels = lab[core]
    pixels = pixels[np.argsort(pixels[:, 0], kind="stable")]
    band = max(1, len(pixels) // 10)
    middles = (np.array([0.125, 0.375, 0.625, 0.875]) * len(pixels)).astype(int)
    return np.array([pixels[max(0, middle - band) : middle + band].mean(0) for middle in middles])


def _skin_pixels(crop: np.ndarray, landmarks: np.ndarray, front: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Front pixels that show the face, and among them those that surely have the colour of its skin.

    Within the landmarks' hull everything is the face (brows, shadows, outlines) but for broad areas of another colour
    that reach in from outside, which are hair; between eyes, nose, mouth and chin there is none. Skin may be lit from
    one side, so within the hull its colour is any of several tones; beyond the hull only the middle one counts.
    """
    width = max(3, int(0.03 * np.ptp(landmarks[:, 0])))
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * width + 1, 2 * width + 1))
    corners = np.round(landmarks).astype(np.int32)
    brows: np.ndarray = np.zeros(front.shape, np.uint8)  # strokes a little thicker than a brow
    cv2.polylines(brows, [corners[PARTS[brow]] for brow in ("brow_right", "brow_left")], False, 1, 2 * width)
    hull, core = brows.copy(), np.zeros_like(brows)
    cv2.fillConvexPoly(hull, cv2.convexHull(corners), 1)
    cv2.fillConvexPoly(core, cv2.convexHull(corners[CORE]), 1)
    # What lies beyond the picture is unknown, so its edge erodes too.
    eroded = cv2.erode(hull, disc, borderType=cv2.BORDER_CONSTANT, borderValue=0)
    inner, core = (eroded | brows).astype(bool) & front, core.astype(bool) & front
    if not core.any():
        return front, front

    lab = cv2.cvtColor(cv2.GaussianBlur(crop, (0, 0), 0.3 * width), cv2.COLOR_RGB2LAB).astype(np.float32)
    lab[..., 0] *= 0.5  # shading changes lightness more than hue
    middle = np.linalg.norm(lab - np.median(lab[core], axis=0), axis=2)
    distance = middle.copy()
    for tone in _skin_tones(lab, core):
        distance = np.where(hull > 0, np.minimum(distance, np.linalg.norm(lab - tone, axis=2)), distance)
    spread = float(np.clip(2.5 * np.median(middle[inner]), *SPREAD))

    broad = cv2.morphologyEx((front & (distance > spread)).astype(np.uint8), cv2.MORPH_OPEN, disc)
    _, labels = cv2.connectedComponents(broad)
    reaching = np.setdiff1d(np.unique(labels[(hull == 0) & (broad > 0)]), 0)
    hair = cv2.dilate(np.isin(labels, reaching).astype(np.uint8), disc[::2, ::2]).astype(bool)
    hair &= ~(brows.astype(bool) | core)
    likely = cv2.erode((front & (distance < spread)).astype(np.uint8), disc[::2, ::2]).astype(bool)
    return (inner | likely) & ~hair, likely & ~hair
