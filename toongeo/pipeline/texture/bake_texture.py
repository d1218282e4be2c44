"""The picture on the UV atlas of the model."""

from functools import lru_cache

import cv2
import numpy as np

from toongeo.io import check_image
from toongeo.model import MorphableModel
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.build_rig import Rig
from toongeo.pipeline.texture.diffuse_over_mesh import diffuse_over_mesh
from toongeo.pipeline.texture.diffuse_texture import diffuse_texture
from toongeo.pipeline.texture.face_picture import FacePicture, face_picture
from toongeo.render import Fragments, interpolate, rasterize, sample_image, uv_to_px

SIZES = (32, 8192)  # texels; in a smaller atlas the eyes would be lost, a larger one takes gigabytes
FADE_RINGS = 24  # edges over which unseen skin fades from its nearest seen colour to the mean skin colour
OBLIQUE, FRONTAL = (
    0.15,
    0.45,
)  # cosines to the viewer between which a texel's trust in the picture grows from 0 to 1
# By how much an expression may enlarge a triangle: up to the first, its drawing stays; from the second, none of it.
STRETCH = (2.0, 5.0)
HIDDEN_MM = 3.0  # how far behind the visible surface a texel may lie and still be taken as seen


def bake_texture(img: np.ndarray, face: AlignedFace, *, rig: Rig | None = None, size: int = 1024) -> np.ndarray:
    """Texture atlas of a face, taken from the picture (Pan et al. 2024, section 3.2.3).

    Every vertex has a place in the picture (Eq. 12). What is not skin there is replaced by the breadth-first diffusion
    of the face colour (:func:`toongeo.diffuse_texture`), and the atlas is filled by rasterizing the model's triangles
    in UV. What the camera does not see, or sees at a grazing angle, takes the colours of the nearest seen skin,
    diffused over the surface and fading to the mean skin colour. Mouth and sockets keep the model's albedo, and so does
    the whole head where no skin is seen.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    face : AlignedFace
    rig : Rig, optional
        Skin that its expressions stretch manyfold, such as the narrow strip of a lid that is open in the picture, takes
        the diffused colour too: a drawn lash there would be smeared over the closed eye.
    size : int
        Side of the atlas in texels.

    Returns
    -------
    (size, size, 3) uint8 RGB
        Row 0 is v = 1. Texels outside the islands repeat the islands' colours, so that filtering does not bleed.

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, or the size no integer from 32 to 8192.
    """
    check_image(img)
    check_size(size)
    picture = face_picture(img, face)
    source = _face_colours(picture)
    unseen = _vertex_colours(face, picture, source)

    atlas = _atlas_fragments(face.model, size)
    rows, columns = np.nonzero(atlas.mask)
    corners = face.faces[atlas.face_ids[rows, columns]]
    weights = atlas.barycentrics[rows, columns]
    fill = _mix(unseen, corners, weights)
    px = _mix(picture.points, corners, weights)
    trust = _trust(face, picture, corners, weights, px)
    if rig is not None:
        trust *= _mix(_calm(face, rig)[:, None], corners, weights)
    seen = sample_image(source, px)
    image = np.zeros((size, size, 3), np.uint8)
    image[rows, columns] = np.clip(np.rint(trust * seen + (1 - trust) * fill), 0, 255)
    return diffuse_texture(image, atlas.mask)


def check_size(size: int) -> None:
    """Refuse an atlas that is too small, too large, or no integer."""
    if not (isinstance(size, int | np.integer) and SIZES[0] <= size <= SIZES[1]):
        raise ValueError(f"size: expected an integer from {SIZES[0]} to {SIZES[1]} texels, got {size!r}")


def _face_colours(picture: FacePicture) -> np.ndarray:
    """The picture with what is not the face replaced by diffused face colour.

    Between lids and lips the diffusion starts at skin outside their outlines, which would otherwise darken the lids.
    """
    if not picture.skin.any():
        return picture.pixels
    width = 1 + 2 * int(0.012 * max(picture.skin.shape))
    around = cv2.dilate(picture.openings.astype(np.uint8), np.ones((width, width), np.uint8)).astype(bool)
    source = diffuse_texture(picture.pixels, picture.skin)
    if (picture.skin & ~around).any():
        source[picture.openings] = diffuse_texture(picture.pixels, picture.skin & ~around)[picture.openings]
    return source


@lru_cache(maxsize=4)
def _atlas_fragments(model: MorphableModel, size: int) -> Fragments:
    return rasterize(uv_to_px(model.uv, size, size), model.uv_faces, size, size)


def _mix(values: np.ndarray, corners: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Vertex values (n, c) at points given by their triangle's corners (k, 3) and barycentrics (k, 3)."""
    return np.einsum("kc,kcd->kd", weights, values[corners])


def _vertex_colours(face: AlignedFace, picture: FacePicture, source: np.ndarray) -> np.ndarray:
    """Colour (n, 3), 0-255, of every vertex: seen, diffused from seen ones, or the model's own inside the mouth."""
    model = face.model
    colours = 255.0 * model.albedo_mean.astype(float)
    outside = model.region("skin") | model.region("neck")
    smooth = cv2.GaussianBlur(source, (0, 0), max(1.0, 0.01 * max(source.shape[:2])))
    # Only pixels that are surely skin feed what is not seen: outlines and hair at the rim would streak over the head.
    safe = cv2.erode(picture.sure.astype(np.uint8), np.ones((5, 5), np.uint8))
    at = sample_image(safe.astype(np.float32)[..., None], picture.points)[:, 0]
    inside = ((picture.points >= 0) & (picture.points <= np.array(safe.shape[::-1]) - 1)).all(1)
    visible = picture.cosines > FRONTAL
    seen = model.region("face") & visible & inside & (at > 0.99)
    if not seen.any():
        return colours
    colours[seen] = sample_image(smooth, picture.points[seen])
    skin = np.median(
        colours[seen & ~model.region("lips")] if (seen & ~model.region("lips")).any() else colours[seen],
        axis=0,
    )
    model_skin = 255.0 * model.albedo_mean[model.region("face")].mean(0)
    colours[~outside] = _muted(colours[~outside], model_skin, skin)
    joined = outside[model.faces].all(1)
    filled, rings = diffuse_over_mesh(model.faces[joined], colours, seen)
    fade = np.clip(rings / FADE_RINGS, 0, 1)[:, None]
    reached = outside & (rings >= 0)
    colours[reached] = ((1 - fade) * filled + fade * skin)[reached]
    return colours


def _muted(colours: np.ndarray, model_skin: np.ndarray, skin: np.ndarray) -> np.ndarray:
    """Colours (k, 3) of the model with as little chroma as the picture's skin has: a grey portrait has a grey mouth."""
    chroma = min(1.0, np.ptp(skin) / max(np.ptp(model_skin), 1.0))
    grey = colours.mean(1, keepdims=True)
    return grey + chroma * (colours - grey)


def _trust(
    face: AlignedFace, picture: FacePicture, corners: np.ndarray, weights: np.ndarray, px: np.ndarray
) -> np.ndarray:
    """How much (k, 1) in [0, 1] each texel believes the picture: frontal, unhidden, on the face, away from its rim."""
    height, width = picture.skin.shape
    ramp = np.clip((picture.cosines - OBLIQUE) / (FRONTAL - OBLIQUE), 0, 1) * face.region("face")
    depth = face.camera.depth(face.vertices)
    front = interpolate(picture.fragments, face.faces, depth[:, None])[..., 0]
    column = np.clip(np.rint(px[:, 0]), 0, width - 1).astype(int)
    row = np.clip(np.rint(px[:, 1]), 0, height - 1).astype(int)
    own = _mix(depth[:, None], corners, weights)[:, 0]
    unhidden = ~picture.fragments.mask[row, column] | (front[row, column] - own < HIDDEN_MM)
    inside = (px[:, 0] >= 0) & (px[:, 0] <= width - 1) & (px[:, 1] >= 0) & (px[:, 1] <= height - 1)
    # Diffused colours are good between lids and lips, where skin surrounds them; elsewhere they end with the skin.
    support = (picture.skin | picture.openings).astype(np.float32)
    soft = cv2.GaussianBlur(cv2.erode(support, np.ones((3, 3))), (0, 0), max(1.0, 0.008 * max(height, width)))
    rim = np.clip(2 * sample_image(soft[..., None], px)[:, 0] - 1, 0, 1)
    frontal = np.einsum("kc,kc->k", weights, ramp[corners])
    return (frontal * unhidden * inside * rim)[:, None]


def _calm(face: AlignedFace, rig: Rig) -> np.ndarray:
    """1 (n,) where no expression stretches the skin much, 0 where one enlarges a triangle manyfold."""
    triangles = face.faces[face.region("face")[face.faces].all(1)]

    def areas(V: np.ndarray) -> np.ndarray:
        a, b, c = V[triangles.T]
        return np.linalg.norm(np.cross(b - a, c - a), axis=1)

    neutral = np.maximum(areas(rig.neutral), 1e-9)
    growth = np.max([areas(rig.neutral + delta) for delta in rig.deltas], axis=0) / neutral
    stretch = np.ones(len(rig.neutral))
    np.maximum.at(stretch, triangles.ravel(), growth.repeat(3))
    return 1 - np.clip((stretch - STRETCH[0]) / (STRETCH[1] - STRETCH[0]), 0, 1)
