"""Colours for what the picture does not show: the surface's own diffusion, hair, and the inside of the mouth.

Constants were chosen by eye on the seven examples.
"""

from functools import lru_cache

import cv2
import numpy as np
import scipy.sparse as sp

from toongeo.geometry import adjacency
from toongeo.model import MorphableModel
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.texture.diffuse_over_mesh import diffused
from toongeo.pipeline.texture.face_picture import FacePicture
from toongeo.pipeline.texture.slant_limits import slant_limits
from toongeo.render import sample_image

__all__ = ["unseen_colours"]

_FADE_RINGS = 24  # edges over which unseen skin fades from its nearest seen colour to the mean skin colour
_INNER_RINGS = 3  # edges over which the inner side of lids and lips takes on the model's colour
_FRONTAL = 0.45  # cosine to the viewer from which a vertex amid the face is seen well
_GRAZING = 0.15  # the same for hair, of which only the middle colour is taken: short hair is seen from the side
_SMOOTHING = 24  # passes that take the streaks out of the breadth-first diffusion
_SOFT = 12  # passes that soften the hairline
_BLUR_SIDE = 256  # px; the picture is blurred at this size
_LIP_VERTICES = 8  # seen of the lips; with fewer they take the colour of the skin
_HAIR_VERTICES = 8  # seen on hair; with fewer the head is taken for bald


def unseen_colours(face: AlignedFace, picture: FacePicture) -> tuple[np.ndarray, np.ndarray]:
    """Colours of vertices as if nothing of the picture could be trusted there, and what the other side lacks.

    Skin takes the colours of the seen skin, diffused breadth first over the surface and smoothed, or those of the
    mirrored side where only that is seen; far off they fade to the mean skin colour. Where the picture has been parsed
    and shows hair, the scalp takes the colour of the hair.

    Returns
    -------
    colours : (n, 3) float64, 0-255
    offset : (n, 3) float64
        What is to be added to the picture at the mirrored vertex, so that it meets the seen side without a seam:
        the difference of the two sides where both are seen, diffused to where one is not.
    """
    model = face.model
    colours = 255.0 * model.albedo_mean.astype(float)
    offset = np.zeros_like(colours)
    seen = _seen(face, picture, picture.sure, slant_limits(model)[1]) & model.region("face")
    if not seen.any():
        return colours, offset
    outside = model.region("skin") | model.region("neck")
    joined = _outer_edges(model)
    own = _blurred_at(picture, picture.sure)
    plain = seen & ~model.region("lips")
    skin = np.median(own[plain if plain.any() else seen], axis=0)
    both = seen & seen[model.mirror]
    if both.any():
        offset = _spread(joined, own - own[model.mirror], both, np.zeros(3))
    lent = seen[model.mirror] & ~seen & model.region("face")
    known = np.where(seen[:, None], own, own[model.mirror] + offset)
    filled = _spread(joined, np.clip(known, 0, 255), seen | lent, skin)
    filled = _with_hair(face, picture, joined, _with_lips(face, picture, joined, filled), seen)
    model_skin = 255.0 * model.albedo_mean[model.region("face")].mean(0)
    colours = np.where(outside[:, None], filled, _matched(colours, model_skin, skin))
    return _inner_rims(model.faces, colours, outside), offset


@lru_cache(maxsize=4)
def _outer_edges(model: MorphableModel) -> sp.csr_array:
    """Edges (n, n) of skin and neck."""
    outside = model.region("skin") | model.region("neck")
    return adjacency(model.faces[outside[model.faces].all(1)], len(model.mean)).astype(float)


def _seen(
    face: AlignedFace, picture: FacePicture, mask: np.ndarray, least: float | np.ndarray = _FRONTAL
) -> np.ndarray:
    """Vertices (n,) that face the camera and fall well inside a mask of the crop."""
    safe = cv2.erode(mask.astype(np.uint8), np.ones((5, 5), np.uint8))
    at = sample_image(safe.astype(np.float32)[..., None], picture.points)[:, 0]
    inside = ((picture.points >= 0) & (picture.points <= np.array(safe.shape[::-1]) - 1)).all(1)
    return (picture.cosines > least) & inside & (at > 0.99)


def _blurred_at(picture: FacePicture, mask: np.ndarray) -> np.ndarray:
    """Colours (n, 3) of the crop at the vertices, blurred within a mask: what lies outside does not mix in."""
    safe = cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(np.float32)
    scale = min(1.0, _BLUR_SIDE / max(mask.shape))
    layers = np.dstack([picture.pixels * safe[..., None], safe])
    layers = cv2.resize(layers, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    layers = cv2.GaussianBlur(layers, (0, 0), max(1.0, 0.01 * max(layers.shape[:2])))
    ratio = np.array(layers.shape[1::-1]) / np.array(mask.shape[::-1])
    values = sample_image(layers, (picture.points + 0.5) * ratio - 0.5).astype(float)
    return values[:, :3] / np.maximum(values[:, 3:], 1e-3)


def _spread(edges: sp.csr_array, values: np.ndarray, known: np.ndarray, far: np.ndarray) -> np.ndarray:
    """Values diffused from known vertices, fading to ``far``, and smoothed where unknown."""
    filled, rings = diffused(edges, values, known, _FADE_RINGS)
    fade = np.clip(rings / _FADE_RINGS, 0, 1)[:, None]
    filled = np.where(rings[:, None] < 0, far, (1 - fade) * filled + fade * far)
    return _smooth(edges, filled, ~known, _SMOOTHING)


def _smooth(edges: sp.csr_array, values: np.ndarray, free: np.ndarray, passes: int) -> np.ndarray:
    """Values whose free vertices took the mean of their neighbours several times."""
    degree = np.diff(edges.indptr)
    rows = np.flatnonzero(free & (degree > 0))
    mean = sp.diags_array(1.0 / degree[rows]) @ edges[rows]
    values = values.copy()
    for _ in range(passes):
        values[rows] = mean @ values
    return values


def _with_lips(face: AlignedFace, picture: FacePicture, joined: sp.csr_array, colours: np.ndarray) -> np.ndarray:
    """Colours whose lips are red up to their inner edges: skin would be a pale rim around an opened mouth."""
    lips = face.region("lips")
    seen = _seen(face, picture, picture.skin) & lips
    if seen.sum() < _LIP_VERTICES:
        return colours
    own, among = _blurred_at(picture, picture.skin), sp.diags_array(lips.astype(float))
    red = _spread(sp.csr_array(among @ joined @ among), own, seen, np.median(own[seen], axis=0))
    return np.where(lips[:, None], red, colours)


def _with_hair(
    face: AlignedFace, picture: FacePicture, joined: sp.csr_array, colours: np.ndarray, skin: np.ndarray
) -> np.ndarray:
    """Colours whose scalp, and forehead where hair falls on it, are those of the parsed hair."""
    regions = face.model.regions
    if picture.hair is None or not {"scalp", "forehead", "ears"} <= set(regions):
        return colours
    hairy = regions["scalp"] | regions["forehead"]
    seen = _seen(face, picture, picture.hair, _GRAZING) & hairy & ~skin
    if seen.sum() < _HAIR_VERTICES:
        return colours
    own = _blurred_at(picture, picture.hair)
    hair = _spread(joined, own, seen, np.median(own[seen], axis=0))
    bare = _seen(face, picture, picture.skin) & hairy
    amount = np.where(seen | (regions["scalp"] & ~bare & _above_nape(face)), 1.0, 0.0)[:, None]
    amount = _smooth(joined, amount, hairy, _SOFT)
    return (1 - amount) * colours + amount * hair


def _above_nape(face: AlignedFace) -> np.ndarray:
    """Vertices (n,) above a line from the top of the ears' front down to the nape, on the mean face."""
    mean, regions = face.model.mean, face.model.regions
    ears, scalp = mean[regions["ears"]], mean[regions["scalp"]]
    front, back = ears[:, 2].max(), scalp[:, 2].min()
    top, low = ears[:, 1].max(), ears[:, 1].min() - 0.6 * np.ptp(ears[:, 1])
    return mean[:, 1] > top + (low - top) * (front - mean[:, 2]) / (front - back)


def _matched(colours: np.ndarray, model_skin: np.ndarray, skin: np.ndarray) -> np.ndarray:
    """The model's colours with as little chroma as the picture's skin has, darker where that is darker."""
    chroma = min(1.0, np.ptp(skin) / max(np.ptp(model_skin), 1.0))
    grey = colours.mean(1, keepdims=True)
    gain = float(np.clip(np.sqrt(skin.mean() / model_skin.mean()), 0.6, 1.1))
    return np.clip(gain * (grey + chroma * (colours - grey)), 0, 255)


def _inner_rims(F: np.ndarray, colours: np.ndarray, outside: np.ndarray) -> np.ndarray:
    """Colours whose inner sides of lids and lips begin with the colour of the skin they continue."""
    near, rings = diffused(adjacency(F, len(colours)), colours, outside, _INNER_RINGS)
    share = np.where(rings < 0, 0.0, np.clip(1 - rings / (_INNER_RINGS + 1), 0, 1))[:, None]
    return np.where(outside[:, None], colours, share * near + (1 - share) * colours)
