"""The drawn eyes on the eyeballs.

Constants were chosen by eye; which of the seven examples and 15 caricatures were looked at was not written down.
"""

from functools import lru_cache

import cv2
import numpy as np

from toongeo.io import check_image
from toongeo.model import EyeballTemplate
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig import Eyes
from toongeo.pipeline.texture.eyes.find_irises import Iris
from toongeo.pipeline.texture.face_picture import EYE_LEFT, EYE_RIGHT, MAX_SIDE, opening_mask
from toongeo.render import Fragments, rasterize, sample_image, uv_to_px

__all__ = ["WHITE", "bake_eyes"]

_OUTLINE = 0.05  # of the eye's width: half the thickness of a drawn line
_FADE = 0.006  # of the disc's width: s.d. of the transition at the lids
_GRAZING = 0.3  # cosine to the line of sight: nearer to the outline, a pixel covers too much of the eyeball
_RINGS = 16  # of an iris, each of one colour where it is not seen
_FEWEST = 8  # texels that must be seen for a colour
_BESIDE = 1.2  # radii of the iris: farther away the eye is white
WHITE = np.array([244.0, 242.0, 238.0])  # unseen sclera, sRGB


def bake_eyes(
    img: np.ndarray,
    face: AlignedFace,
    eyes: Eyes,
    texture: np.ndarray,
    irises: tuple[Iris | None, Iris | None] = (None, None),
) -> np.ndarray:
    """Atlas whose eye discs show the eyes of the picture where they are seen; what lids hide is completed.

    A texel is seen if it projects between the lids, that is inside the smooth curves through the eye landmarks, with
    the eyes turned as in the picture. The hidden part of an iris takes the median colour of its seen parts at the
    same distance from its centre; beyond it the eye is as white as the seen white.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    face : AlignedFace
    eyes : Eyes
    texture : (size, size, 3) uint8 RGB
        From :func:`toongeo.bake_texture`; not written to.
    irises : left and right Iris or None, optional
        From :func:`find_irises`; an eye without is white where it is not seen.

    Returns
    -------
    (size, size, 3) uint8 RGB

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, or the texture not square uint8 RGB.
    """
    check_image(img)
    if texture.dtype != np.uint8 or texture.ndim != 3 or texture.shape[0] != texture.shape[1] or texture.shape[2] != 3:
        raise ValueError(f"texture: expected (size, size, 3) uint8, got {texture.dtype} of shape {texture.shape}")
    atlas = texture.copy()
    landmarks = face.project(face.vertices[face.landmark_vertices])
    for side, rims in enumerate((EYE_LEFT, EYE_RIGHT)[: len(eyes.templates)]):
        crop, shift, scale = _eye_crop(img, landmarks[np.unique(np.concatenate(rims))])
        opening = opening_mask((landmarks - shift + 0.5) * scale - 0.5, rims, crop.shape[:2])
        opening = _within_outline(opening)
        disc = _disc_fragments(eyes.templates[side], len(texture))
        rows, columns = np.nonzero(disc.mask)
        box = np.s_[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
        corners = eyes.templates[side].faces[disc.face_ids[disc.mask]]
        turned = eyes.looking_as_drawn(side)
        px = (face.project(turned) - shift + 0.5) * scale - 0.5
        ahead = face.camera.view(turned - eyes.centres[side])[:, 2] / eyes.radii[side]
        weights = disc.barycentrics[disc.mask]
        at = np.einsum("kc,kcd->kd", weights, px[corners])
        column = np.clip(np.rint(at[:, 0]), 0, crop.shape[1] - 1).astype(int)
        row = np.clip(np.rint(at[:, 1]), 0, crop.shape[0] - 1).astype(int)
        front = np.einsum("kc,kc->k", weights, ahead[corners]) > _GRAZING
        seen = opening[row, column] & front
        colours = sample_image(crop, at)
        unseen = np.tile(WHITE, (len(at), 1))
        iris = irises[side]
        if iris is not None:
            away = np.linalg.norm(((at + 0.5) / scale - 0.5 + shift - iris.centre) / iris.radii, axis=1)
            unseen = _completed(colours, np.where(front, away, np.inf), seen)
        atlas[box] = _disc_image(rows - rows.min(), columns - columns.min(), colours, seen, unseen)
    return atlas


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
def _disc_fragments(template: EyeballTemplate, size: int) -> Fragments:
    return rasterize(uv_to_px(template.uv, size, size), template.faces, size, size)


def _completed(colours: np.ndarray, away: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """Colours (k, 3) of an eye where it is not seen, by the distance ``away`` (k,) from its iris in radii of that."""
    bins = np.linspace(0, 1, _RINGS + 1)
    ring = np.digitize(away, bins) - 1
    known = [k for k in range(_RINGS) if (seen & (ring == k)).sum() >= _FEWEST]
    white = seen & (away > _BESIDE)
    lightness = colours[white].sum(1)
    lit = lightness >= np.median(lightness) if white.any() else lightness
    sclera = np.median(colours[white][lit], axis=0) if white.sum() >= _FEWEST else WHITE
    unseen = np.tile(sclera, (len(colours), 1))
    if known:
        medians = np.array([np.median(colours[seen & (ring == k)], axis=0) for k in known])
        within = away < 1
        middles = (bins[:-1] + bins[1:])[known] / 2
        unseen[within] = np.column_stack([np.interp(away[within], middles, column) for column in medians.T])
    return unseen


def _disc_image(
    rows: np.ndarray, columns: np.ndarray, colours: np.ndarray, seen: np.ndarray, unseen: np.ndarray
) -> np.ndarray:
    """The square of the atlas about a disc: seen colours, smoothly joined to those of the unseen."""
    shape = rows.max() + 1, columns.max() + 1
    image, known = np.full((*shape, 3), WHITE), np.zeros(shape, bool)
    beyond = image.copy()
    beyond[rows, columns] = unseen
    image[rows[seen], columns[seen]] = colours[seen]
    known[rows[seen], columns[seen]] = True
    if not known.all():
        # Seen colours reach a little beyond the lids, where they are mixed with those of the unseen.
        share = cv2.GaussianBlur(known.astype(np.float64), (0, 0), _FADE * known.shape[1])[..., None]
        near = cv2.GaussianBlur(np.where(known[..., None], image, 0), (0, 0), _FADE * known.shape[1])
        mixed = beyond + np.clip(2 * share, 0, 1) * (near / np.maximum(share, 1e-6) - beyond)
        image = np.where(known[..., None], image, mixed)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)
