"""Which pixels of a crop are the skin of its face.

Constants were chosen on the seven examples, whose painted backgrounds must not come through.
"""

import cv2
import numpy as np

from toongeo.model.ibug68 import PARTS
from toongeo.protocols import FaceLabel

__all__ = ["amid", "resized", "skin_mask", "skin_weight"]

_SKIN_SIDE = 480  # px; skin is looked for at this size
_PARSED_FACE = (
    FaceLabel.SKIN,
    FaceLabel.BROW_LEFT,
    FaceLabel.BROW_RIGHT,
    FaceLabel.EYE_LEFT,
    FaceLabel.EYE_RIGHT,
    FaceLabel.NOSE,
    FaceLabel.UPPER_LIP,
    FaceLabel.LOWER_LIP,
    FaceLabel.INNER_MOUTH,
)
_SPREAD = (
    7.0,
    13.0,
)  # CIELAB units: least and largest distance from the skin's colour that still counts as skin
_STRANGE = 26.0  # CIELAB units, lightness halved: farther than this from every tone of the face is not face
# Chin, nose, eye and mouth corners: within their hull there is no hair.
_CORE = np.r_[PARTS["jaw"][4:13], PARTS["nose"], 36, 39, 42, 45, 48, 54]


def resized(layer: np.ndarray, shape: tuple[int, ...], method: int) -> np.ndarray:
    """A layer of the picture at the size of the crop."""
    return np.asarray(cv2.resize(layer, (shape[1], shape[0]), interpolation=method))


def skin_mask(
    crop: np.ndarray, landmarks: np.ndarray, front: np.ndarray, parts: np.ndarray | None, rim: int
) -> tuple[np.ndarray, np.ndarray]:
    """Skin and sure skin (h, w) bool of the crop, found at a reduced size, with eroded silhouettes."""
    scale = min(1.0, _SKIN_SIDE / max(crop.shape[:2]))
    if parts is None:
        non_skin = _non_skin(crop, landmarks)
        allowed = (~non_skin).astype(np.uint8)
        # One colour for all that surrounds the face: which one it was must not show.
        core = _core(_inwards(landmarks), crop.shape) > 0
        dark = bool(core.any()) and np.median(crop[core]) > 127
        crop = np.where(non_skin[..., None], np.uint8(0 if dark else 255), crop)
    else:
        # Beards, glasses and drawn lines are part of the face.
        drawn = (parts != FaceLabel.BACKGROUND) & (amid(landmarks, front.shape) > 0)
        # Strands that hang over the sides of the cheeks are not.
        drawn &= (parts != FaceLabel.HAIR) | (amid(_inwards(landmarks), front.shape) > 0)
        allowed = (np.isin(parts, _PARSED_FACE) | drawn).astype(np.uint8)
        if (allowed & front).any():
            # What is not the face takes its middle colour, so that no background blurs into the statistics.
            crop = np.where(
                allowed[..., None] > 0, crop, np.median(crop[(allowed & front) > 0], axis=0).astype(np.uint8)
            )
    small = crop if scale == 1 else cv2.resize(crop, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    reduced = front if scale == 1 else resized(front.astype(np.uint8), small.shape, cv2.INTER_AREA) > 0
    given = np.zeros(reduced.shape, bool)
    if parts is not None:
        given = resized(np.isin(parts, _PARSED_FACE).astype(np.uint8), small.shape, cv2.INTER_NEAREST) > 0
    masks = _skin_pixels(small, (landmarks + 0.5) * scale - 0.5, reduced, given)
    # What lies beyond the picture is unknown, so its edge erodes too.
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * rim + 1, 2 * rim + 1))
    inside = cv2.erode(allowed, disc, borderType=cv2.BORDER_CONSTANT, borderValue=0).astype(bool) & front
    found = [resized(mask.astype(np.float32), crop.shape, cv2.INTER_LINEAR) > 0.5 for mask in masks]
    return found[0] & inside, found[1] & found[0] & inside


def amid(landmarks: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """1 (h, w) float32 in the core and on the brows, which a parser may take for hair or lines."""
    amid = _core(landmarks, shape)
    corners = np.round(landmarks).astype(np.int32)
    thickness = max(1, round(0.06 * np.ptp(landmarks[:, 0])))
    for brow, eye in (("brow_right", "eye_right"), ("brow_left", "eye_left")):
        cv2.polylines(amid, [corners[PARTS[brow]]], False, 1.0, thickness)
        cv2.fillConvexPoly(amid, cv2.convexHull(np.vstack([corners[PARTS[brow]], corners[PARTS[eye]]])), 1.0)
    return amid


def _non_skin(crop: np.ndarray, landmarks: np.ndarray) -> np.ndarray:
    """Pixels (h, w) bool about the core of the face that have none of the colours within it: background and hair.

    Within the hull of the landmarks only those that reach its outside count; others are drawn on the face.
    """
    core = _core(_inwards(landmarks), crop.shape) > 0
    if not core.any():
        return np.zeros(core.shape, bool)
    lab = cv2.cvtColor(crop, cv2.COLOR_RGB2LAB).astype(np.float32)
    lab[..., 0] *= 0.5
    tones = _skin_tones(lab, core)
    distance = np.min([np.linalg.norm(lab - tone, axis=2) for tone in tones], axis=0)
    far = (distance > _STRANGE) & (amid(_inwards(landmarks), crop.shape) == 0)  # brows may touch the hair
    hull = np.zeros(core.shape, np.uint8)
    cv2.fillConvexPoly(hull, cv2.convexHull(np.round(landmarks).astype(np.int32)), 1)
    _, labels = cv2.connectedComponents(far.astype(np.uint8))
    return far & np.isin(labels, np.unique(labels[far & (hull == 0)]))


def _inwards(landmarks: np.ndarray) -> np.ndarray:
    """Landmarks whose jaw is drawn towards the nose: where jaw points are off, the core still holds no background."""
    moved = landmarks.copy()
    moved[PARTS["jaw"]] += 0.2 * (landmarks[33] - landmarks[PARTS["jaw"]])
    return moved


def _core(landmarks: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """1 (h, w) float32 between eyes, nose, mouth and chin, 0 elsewhere."""
    core = np.zeros(shape[:2], np.float32)
    cv2.fillConvexPoly(core, cv2.convexHull(np.round(landmarks[_CORE]).astype(np.int32)), 1.0)
    return core


def skin_weight(skin: np.ndarray, openings: np.ndarray, feather: float) -> np.ndarray:
    """Trust (h, w) float32 that grows from the outer rim of the skin, and at once from the rims of the openings."""
    # Gaps narrower than the feather, such as lines, are no rims.
    width = 1 + 2 * round(max(feather, 1.0) / 2)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (width, width))
    support = cv2.morphologyEx((skin | openings).astype(np.uint8), cv2.MORPH_CLOSE, disc)
    distance = cv2.distanceTransform(np.pad(support, 1), cv2.DIST_L2, 5)[1:-1, 1:-1]
    growth = np.clip((distance - 1) / max(feather, 1.0), 0, 1)
    sharp = cv2.GaussianBlur(skin.astype(np.float32), (0, 0), 1.0)
    return (growth * growth * (3 - 2 * growth) * np.clip(2 * sharp, 0, 1)).astype(np.float32)


def _skin_tones(lab: np.ndarray, core: np.ndarray) -> np.ndarray:
    """Colours (4, 3) of skin from shadow to light: the mean about each of four levels of lightness in the core."""
    pixels = lab[core]
    pixels = pixels[np.argsort(pixels[:, 0], kind="stable")]
    band = max(1, len(pixels) // 10)
    middles = (np.array([0.125, 0.375, 0.625, 0.875]) * len(pixels)).astype(int)
    return np.array([pixels[max(0, middle - band) : middle + band].mean(0) for middle in middles])


def _skin_pixels(
    crop: np.ndarray, landmarks: np.ndarray, front: np.ndarray, given: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Front pixels that show the face, and among them those that surely have the colour of its skin.

    Within the landmarks' hull everything is the face (brows, shadows, outlines) but for broad areas of another colour
    that reach in from outside, which are hair; between eyes, nose, mouth and chin there is none. Skin may be lit from
    one side, so within the hull its colour is any of several tones; beyond the hull only the middle one counts, unless
    a parse gives the pixel as face: foreheads gleam, and pale or dark ones are foreheads still.
    """
    width = max(3, int(0.03 * np.ptp(landmarks[:, 0])))
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * width + 1, 2 * width + 1))
    corners = np.round(landmarks).astype(np.int32)
    brows: np.ndarray = np.zeros(front.shape, np.uint8)  # strokes a little thicker than a brow
    cv2.polylines(brows, [corners[PARTS[brow]] for brow in ("brow_right", "brow_left")], False, 1, 2 * width)
    hull, core = brows.copy(), np.zeros_like(brows)
    cv2.fillConvexPoly(hull, cv2.convexHull(corners), 1)
    cv2.fillConvexPoly(core, cv2.convexHull(corners[_CORE]), 1)
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
    spread = float(np.clip(2.5 * np.median(middle[inner]), *_SPREAD))

    broad = cv2.morphologyEx((front & (distance > spread) & ~given).astype(np.uint8), cv2.MORPH_OPEN, disc)
    _, labels = cv2.connectedComponents(broad)
    reaching = np.setdiff1d(np.unique(labels[(hull == 0) & (broad > 0)]), 0)
    hair = cv2.dilate(np.isin(labels, reaching).astype(np.uint8), disc[::2, ::2]).astype(bool)
    hair &= ~(brows.astype(bool) | core)
    like_skin = (distance < spread) | (given & (hull == 0))
    likely = cv2.erode((front & like_skin).astype(np.uint8), disc[::2, ::2]).astype(bool)
    return (inner | likely) & ~hair, likely & ~hair
