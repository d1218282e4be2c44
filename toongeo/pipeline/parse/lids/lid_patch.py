"""The surroundings of one eye, upright and always of the same size, in channels that tell eye from skin.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/snapping.py``).
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.colour.cielab import cielab
from toongeo.model.ibug68 import LID_RIMS, MIRROR, PARTS
from toongeo.pipeline.parse.masks import filled
from toongeo.pipeline.parse.skin_surface import SkinSurface, colour_mode, skin_surface

__all__ = ["CHANNELS", "EYES_APART", "RESOLUTION", "LidPatch", "eye_points", "lid_patch", "lid_unit"]

RESOLUTION = 100.0  # px of a patch per outer-eye distance
CHANNELS = ("eye", "non_skin", "stroke", "light", "redness", "yellowness", "brow")

_MARGIN = 0.26  # outer-eye distances around the given eye: so far its lids are looked for
_STROKE_PX = 7  # broadest line that counts as a stroke
_BROW_PX = 7  # breadth of a brow
_SEED_SIDE = 150  # px; the cheek's colour is taken from a reduced picture
EYES_APART = 0.68  # of the outer-eye distance: what the eyes' centres are apart
# Pairs that lie level in an upright head: jaw ends, brow ends, wings of the nose, mouth corners.
_LEVEL = np.array([[0, 16], [17, 26], [31, 35], [48, 54]])
# Cheek of the subject's right side: jaw, mouth corner, wing and root of the nose.
_CHEEK = np.array([0, 1, 2, 3, 4, 48, 31, 27])


@dataclass(frozen=True, eq=False)
class LidPatch:
    """One eye as a right eye: a left one is mirrored.

    Attributes
    ----------
    channels : (h, w, 7) float32
        ``CHANNELS``: unlike skin, with strokes of lines as neutral (0.5); unlike skin; dark stroke; then lightness,
        a and b relative to the skin's, squashed into (-1, 1); brow.
    matrix : (2, 3) float64
        From the picture to the patch, px.
    lids : (6, 2) float64
        The given landmarks in the patch: outer corner, upper lid, inner corner, lower lid.
    """

    channels: NDArray[np.float32]
    matrix: Floats
    lids: Floats

    def to_picture(self, points: Floats) -> Floats:
        """Pixels (k, 2) of the patch as pixels of the picture."""
        return (points - self.matrix[:, 2]) @ np.linalg.inv(self.matrix[:, :2]).T


def eye_points(side: str) -> NDArray[np.int64]:
    """The six landmarks of an eye from its outer corner over the upper lid to the inner corner and back."""
    right = np.array([*LID_RIMS["lid_upper_right"], *LID_RIMS["lid_lower_right"][-2:0:-1]])
    return right if side == "right" else MIRROR[right]


def lid_unit(landmarks: Floats) -> float:
    """Outer-eye distance, px, told from the eyes' centres, which shrunken eyes do not move."""
    right, left = (landmarks[eye_points(side)].mean(axis=0) for side in ("right", "left"))
    return max(float(np.linalg.norm(right - left)) / EYES_APART, 1.0)


def lid_patch(img: NDArray[np.uint8], landmarks: Floats, side: str) -> LidPatch:
    """The surroundings of an eye.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float64, px, none missing
    side : {"left", "right"}
        Of the subject.
    """
    index = np.arange(68) if side == "right" else MIRROR
    points = landmarks[index]
    matrix, size = _frame(points, lid_unit(landmarks), mirrored=side == "left")
    pixels = _resampled(img, matrix, size)
    placed = points @ matrix[:, :2].T + matrix[:, 2]
    lab = cielab(pixels)
    head = filled(lab.shape[:2], np.asarray(cv2.convexHull(placed.astype(np.float32)), np.float64)[:, 0])
    brow = _brow(lab.shape[:2], placed[PARTS["brow_right"]])
    seed = _cheek_colour(img, points, lab)
    return LidPatch(
        _channels(lab, skin_surface(lab, seed, head & ~brow), head, brow), matrix, placed[eye_points("right")]
    )


def _frame(points: Floats, unit: float, *, mirrored: bool) -> tuple[Floats, int]:
    """Matrix (2, 3) from the picture to the patch, and the patch's side.

    The tilt of the head is told from pairs of points that are not the eyes', which are in doubt.
    """
    across = points[_LEVEL[:, 1]] - points[_LEVEL[:, 0]]
    x, y = (across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)).sum(axis=0)
    length = max(float(np.hypot(x, y)), 1e-9)
    upright = np.array([[x, y], [y, -x] if mirrored else [-y, x]]) / length
    lids = points[eye_points("right")]
    centre, factor = lids.mean(axis=0), RESOLUTION / unit
    half = int(np.ceil((np.abs(lids - centre).max() + _MARGIN * unit) * factor))
    linear = factor * upright
    return np.column_stack([linear, half - linear @ centre]), 2 * half + 1


def _resampled(img: NDArray[np.uint8], matrix: Floats, size: int) -> NDArray[np.uint8]:
    """The picture in the patch, without aliasing; beyond the border its last pixels go on."""
    factor = float(np.sqrt(abs(np.linalg.det(matrix[:, :2]))))
    ends = np.array([[-1, -1], [size, -1], [-1, size], [size, size]])
    corners = (ends - matrix[:, 2]) @ np.linalg.inv(matrix[:, :2]).T
    reach = int(np.ceil(4 / factor)) + 2
    limit = np.array(img.shape[1::-1])
    x0, y0 = np.clip(np.floor(corners.min(axis=0)).astype(int) - reach, 0, limit - 1)
    x1, y1 = np.clip(np.ceil(corners.max(axis=0)).astype(int) + reach, [x0 + 1, y0 + 1], limit)
    part = np.ascontiguousarray(img[y0:y1, x0:x1])
    if factor < 0.7:
        part = np.asarray(cv2.GaussianBlur(part, (0, 0), 0.45 / factor, borderType=cv2.BORDER_REPLICATE), np.uint8)
    shifted = matrix.copy()
    shifted[:, 2] += matrix[:, :2] @ [x0, y0]
    method = cv2.INTER_CUBIC if factor >= 1 else cv2.INTER_LINEAR
    placed = cv2.warpAffine(part, shifted, (size, size), flags=method, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(placed, np.uint8)


def _cheek_colour(img: NDArray[np.uint8], points: Floats, lab: NDArray[np.float32]) -> Floats:
    """The commonest Lab colour of the cheek on this side; that of the patch if the cheek is out of the picture."""
    factor = min(1.0, _SEED_SIDE / max(np.ptp(points, axis=0).max(), 1.0))
    small = img
    if factor < 1:
        small = np.asarray(cv2.resize(img, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA), np.uint8)
    cheek = filled(small.shape[:2], points[_CHEEK] * factor) & ~filled(
        small.shape[:2], points[eye_points("right")] * factor
    )
    colours = cielab(np.ascontiguousarray(small[cheek][None]))[0]
    return colour_mode(np.asarray(colours if len(colours) > 5 else lab.reshape(-1, 3), np.float64))


def _brow(shape: tuple[int, int], points: Floats) -> NDArray[np.bool_]:
    """The brow (5, 2) and all that is above it."""
    mask = filled(shape, np.vstack([points, points[::-1] - [0, 3 * RESOLUTION]])).astype(np.uint8)
    cv2.polylines(mask, [np.round(points).astype(np.int32)], False, 1, _BROW_PX)
    return mask.astype(bool)


def _channels(
    lab: NDArray[np.float32], skin: SkinSurface, head: NDArray[np.bool_], brow: NDArray[np.bool_]
) -> NDArray[np.float32]:
    """``CHANNELS`` (h, w, 7)."""
    off = lab - skin.colour
    non_skin = 1 - np.exp(-0.5 * (off**2).sum(axis=2) / (2.2 * skin.spread) ** 2)
    spread = (np.std(off[head], axis=0).mean() if head.any() else 0.0) + 4.0
    lightness = np.ascontiguousarray(lab[..., 0])
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (_STROKE_PX, _STROKE_PX))
    valley = cv2.morphologyEx(lightness, cv2.MORPH_CLOSE, kernel) - lightness
    stroke = np.clip(valley / (1.5 * spread), 0, 1) * (off[..., 0] < 0)
    squashed = np.tanh(off / (spread * np.array([2.0, 1.0, 1.0])))
    soft_brow = cv2.GaussianBlur(brow.astype(np.float32), (0, 0), 2)
    planes = [non_skin * (1 - stroke) + 0.5 * stroke, non_skin, stroke, *np.moveaxis(squashed, 2, 0), soft_brow]
    return np.stack(planes, axis=2).astype(np.float32)
