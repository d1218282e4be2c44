"""The drawn inside of a mouth on teeth, tongue and cavity.

Constants: see ``benchmarks/mouths.py``.
"""

import cv2
import numpy as np

from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.parse.drawn_mouth import DrawnMouth
from toongeo.render import Fragments, interpolate, rasterize, sample_image
from toongeo.render.interpolate import blend_corners

__all__ = ["paint_mouth"]

_BEHIND_MM = 1.0  # behind what is seen: so far a texel still counts as seen
_FEATHER = 0.012  # of the mouth's width: over this distance the picture grows in from the edge of its class
_SIDE = 600  # px: of the drawing by which it is told what is seen
_FEWEST = 20  # pixels of a class for its colour
_GAIN = (0.15, 1.3)  # of the colour of what is not seen
_CAVITY = (0.12, 1.1)  # of its lightness
_SHARES = (0.12, 0.05)  # of the opening that is tongue or dark, at least, for its colour


def paint_mouth(
    texture: np.ndarray, atlas: Fragments, img: np.ndarray, face: AlignedFace, mouth: DrawnMouth | None
) -> np.ndarray:
    """Atlas whose teeth and tongue show those of the picture where they are seen.

    A tooth takes pixels of drawn teeth only, and tongue and cavity those between the lips that are no teeth, so that
    neither is smeared over the other. What is not seen keeps the model's drawing, in the colour of the drawn part.

    Parameters
    ----------
    texture : (size, size, 3) uint8 RGB
        Not written to.
    atlas : Fragments
        The model's triangles in the atlas.
    img : (H, W, 3) uint8 RGB
    face : AlignedFace
        With teeth and tongue as they are in the pose of the picture.
    mouth : DrawnMouth or None

    Returns
    -------
    (size, size, 3) uint8 RGB
    """
    if mouth is None or not face.model.has("teeth_upper", "mouth_cavity"):
        return texture
    px, depth = face.project(face.vertices), face.camera.depth(face.vertices)
    front = _Front(face, mouth, px, depth)
    dark = mouth.inside & ~mouth.teeth & ~mouth.tongue
    many = np.count_nonzero(mouth.inside)
    tongue = mouth.tongue if np.count_nonzero(mouth.tongue) > _SHARES[0] * many else None
    sources = {
        "teeth_upper": (mouth.teeth, mouth.teeth),
        "teeth_lower": (mouth.teeth, mouth.teeth),
        "tongue": (mouth.inside & ~mouth.teeth, tongue),
        "mouth_cavity": (mouth.inside & ~mouth.teeth, dark if np.count_nonzero(dark) > _SHARES[1] * many else None),
    }
    flat, ids = texture.reshape(-1, 3).astype(float), atlas.face_ids.ravel()
    for part, (shown, coloured) in sources.items():
        texels = np.flatnonzero(atlas.mask.ravel() & face.region(part)[face.faces].all(1)[ids])
        at = blend_corners(
            np.column_stack([px, depth]).astype(np.float32)[face.faces],
            ids[texels],
            atlas.barycentrics.reshape(-1, 3)[texels],
        )
        flat[texels] = _in_colour(flat[texels], img, coloured, part)
        share = front.sees(at) * _feathered(shown, at[:, :2], _FEATHER * mouth.width)
        seen = np.flatnonzero(share > 0)
        flat[texels[seen]] += share[seen, None] * (sample_image(img, at[seen, :2]) - flat[texels[seen]])
    return np.clip(np.rint(flat), 0, 255).astype(np.uint8).reshape(texture.shape)


class _Front:
    """What of the head is seen in the picture's opening."""

    def __init__(self, face: AlignedFace, mouth: DrawnMouth, px: np.ndarray, depth: np.ndarray) -> None:
        rows, columns = np.nonzero(mouth.inside)
        margin = 0.2 * mouth.width
        self._low = np.array([columns.min(), rows.min()]) - margin
        size = np.array([columns.max(), rows.max()]) + margin - self._low
        self._scale = _SIDE / size.max()
        width, height = np.ceil(size * self._scale).astype(int)
        self._mask = rasterize(np.column_stack([self._place(px), depth]), face.faces, height, width)
        self._depth = interpolate(self._mask, face.faces, depth)

    def _place(self, px: np.ndarray) -> np.ndarray:
        return np.asarray((px - self._low + 0.5) * self._scale - 0.5)

    def sees(self, at: np.ndarray) -> np.ndarray:
        """Which of the places (k, 3) px, px, mm are not hidden."""
        place = np.rint(self._place(at[:, :2])).astype(int)
        limits = np.array(self._depth.shape[::-1])
        inside = ((place >= 0) & (place < limits)).all(1)
        column, row = np.clip(place, 0, limits - 1).T
        return np.asarray(inside & self._mask.mask[row, column] & (self._depth[row, column] - at[:, 2] < _BEHIND_MM))


def _feathered(mask: np.ndarray, px: np.ndarray, over: float) -> np.ndarray:
    """How far inside a mask of the picture places (k, 2) lie, growing from 0 to 1 within ``over`` pixels."""
    within = cv2.distanceTransform(mask.astype(np.uint8), cv2.DIST_L2, 3)
    inside = ((px >= 0) & (px <= np.array(mask.shape[::-1]) - 1)).all(1)
    return np.asarray(inside * np.clip(sample_image(within[..., None], px)[:, 0] / max(1.0, over), 0, 1))


def _in_colour(own: np.ndarray, img: np.ndarray, drawn: np.ndarray | None, part: str) -> np.ndarray:
    """The model's colours (k, 3) of a part, in the middle colour of the pixels that are drawn of it."""
    if drawn is None or np.count_nonzero(drawn) <= _FEWEST or not len(own):
        return own
    middle, lightness = np.median(img[drawn], axis=0), own.mean(1)
    if part == "mouth_cavity":
        return own * np.clip(middle.mean() / max(np.median(lightness), 1.0), *_CAVITY)
    # The crowns are what is drawn of teeth, not the gums.
    crowns = lightness >= np.median(lightness) if part.startswith("teeth") else lightness >= 0
    return own * np.clip(middle / np.maximum(np.median(own[crowns], axis=0), 1.0), *_GAIN)
