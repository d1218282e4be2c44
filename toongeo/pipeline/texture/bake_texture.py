"""The picture on the UV atlas of the model.

Constants were chosen by eye on the seven examples.
"""

import dataclasses
from functools import lru_cache

import numpy as np

from toongeo.io import check_image
from toongeo.model import MorphableModel, atlas_coordinates
from toongeo.model.anatomy.lid_rings import lids_of
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.parse.drawn_mouth import drawn_mouth
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.texture.diffuse_texture import diffuse_texture
from toongeo.pipeline.texture.face_picture import FacePicture, face_picture
from toongeo.pipeline.texture.lids.paint_lids import paint_lids
from toongeo.pipeline.texture.mouth.paint_mouth import paint_mouth
from toongeo.pipeline.texture.remove_shading import remove_shading
from toongeo.pipeline.texture.sample_area import sample_area
from toongeo.pipeline.texture.slant_limits import slant_limits
from toongeo.pipeline.texture.unseen_colours import unseen_colours
from toongeo.protocols import FaceParse
from toongeo.render import Fragments, interpolate, rasterize, sample_image, uv_to_px
from toongeo.render.interpolate import blend_corners

__all__ = ["bake_texture", "check_size"]

_SIZES = (32, 8192)  # texels; in a smaller atlas the eyes would be lost, a larger one takes gigabytes
# By how much an expression may enlarge a triangle: up to the first, its drawing stays; from the second, none of it.
_STRETCH = (2.0, 5.0)
_HIDDEN_MM = 3.0  # how far behind the visible surface a texel may lie and still be taken as seen


def bake_texture(
    img: np.ndarray,
    face: AlignedFace,
    *,
    rig: Rig | None = None,
    size: int = 1024,
    parse: FaceParse | None = None,
    delight: bool = False,
) -> np.ndarray:
    """Texture atlas of a face, taken from the picture (Pan et al. 2024, section 3.2.3).

    Every texel has a place in the picture (Eq. 12), from which it takes the mean over what it covers, as far as it is
    seen there: weight is visibility x view angle x distance from the rim of the skin x confidence of the parse. The
    remainder comes from the mirrored side where that is seen, raised or lowered to meet the seen side without a seam,
    and what neither side shows from the seen skin, diffused breadth first over the surface. The scalp takes the colour
    of the hair if the parse has any. Mouth and sockets keep the model's albedo, matched to the picture's skin, and so
    does the whole head where no skin is seen; but teeth and tongue that a parse shows between the lips are painted.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    face : AlignedFace
    rig : Rig, optional
        Skin that its expressions stretch manyfold takes the diffused colour too. The strip of a lid that a blink draws
        over the whole eye becomes plain skin, as it is around the eye, and its lashes a line along its edge: as drawn,
        they would be smeared over the closed eye.
    size : int
        Side of the atlas in texels.
    parse : FaceParse, optional
        Of the same picture. Without it, skin is told from hair and background by its colour, and no hair is painted.
    delight : bool
        Divide the light of the fit out of the picture: the atlas is albedo, to be lit anew.

    Returns
    -------
    (size, size, 3) uint8 RGB
        Row 0 is v = 1. Texels outside the islands repeat the islands' colours, so that filtering does not bleed.

    Raises
    ------
    ValueError
        If the picture is not (H, W, 3) uint8, the size no integer from 32 to 8192, the parse of another size than the
        picture, or ``delight`` is asked of a fit without light.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> face = tg.align_face(tg.fit_3dmm(None, landmarks), landmarks)
    >>> tg.bake_texture(img, face, size=256).shape
    (256, 256, 3)
    """
    check_image(img)
    check_size(size)
    picture = face_picture(img, face, parse)
    if delight:
        picture = dataclasses.replace(picture, pixels=remove_shading(picture, face))
    unseen, offset = unseen_colours(face, picture)
    atlas = _atlas_fragments(face.model, size)
    texels = np.flatnonzero(atlas.mask)
    ids, weights = atlas.face_ids.ravel()[texels], atlas.barycentrics.reshape(-1, 3)[texels]
    colours = blend_corners(unseen.astype(np.float32)[face.faces], ids, weights)

    front = np.flatnonzero(face.region("face")[face.faces].all(1)[ids])
    ids, weights = ids[front], weights[front]
    shared = np.ones(len(face.vertices)) if rig is None else _calm(face, rig)
    places, mirror = _Places(face, picture, shared, size), face.model.mirror
    px, confidence, footprint = places.of(np.arange(len(mirror)), ids, weights)
    seen, doubtful = np.flatnonzero(confidence > 0), np.flatnonzero(confidence < 1)
    over = sample_area(picture.pixels, px[seen], footprint[seen]), confidence[seen, None]
    # The mirrored side beneath the seen one.
    ids, weights = ids[doubtful], weights[doubtful]
    px, confidence, footprint = places.of(mirror, ids, weights)
    lent = np.flatnonzero(confidence > 0)
    other = sample_area(picture.pixels, px[lent], footprint[lent])
    other = np.clip(other + blend_corners(offset.astype(np.float32)[face.faces], ids[lent], weights[lent]), 0, 255)
    for rows, colour, share in ((front[doubtful[lent]], other, confidence[lent, None]), (front[seen], *over)):
        colours[rows] = share * colour + (1 - share) * colours[rows]
    image = np.zeros((size * size, 3), np.uint8)
    image[texels] = np.clip(np.rint(colours), 0, 255)
    texture = image.reshape(size, size, 3)
    if parse is not None:
        texture = paint_mouth(texture, atlas, img, face, drawn_mouth(img, parse))
    texture = diffuse_texture(texture, atlas.mask)
    return texture if rig is None else paint_lids(texture, atlas, img, face, rig)


def check_size(size: int) -> None:
    """Refuse an atlas that is too small, too large, or no integer."""
    if not (isinstance(size, int | np.integer) and _SIZES[0] <= size <= _SIZES[1]):
        raise ValueError(f"size: expected an integer from {_SIZES[0]} to {_SIZES[1]} texels, got {size!r}")


@lru_cache(maxsize=4)
def _atlas_fragments(model: MorphableModel, size: int) -> Fragments:
    atlas = atlas_coordinates(model)
    texels = uv_to_px(atlas.uv, size, size)
    if atlas.height is not None:
        texels = np.column_stack([texels, atlas.height])
    return rasterize(texels, atlas.uv_faces, size, size)


class _Places:
    """Where texels lie in the picture, and how far it is to be believed there."""

    def __init__(self, face: AlignedFace, picture: FacePicture, shared: np.ndarray, size: int) -> None:
        self.face, self.picture = face, picture
        low, high = slant_limits(face.model)
        ramp = np.clip((picture.cosines - low) / (high - low), 0, 1) * face.region("face")
        depth = face.camera.depth(face.vertices)
        self.front = interpolate(picture.fragments, face.faces, depth)
        self.values = np.column_stack([picture.points, ramp, depth, _footprints(face, picture, size)])
        self.shared = shared

    def of(self, order: np.ndarray, ids: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Pixels (k, 2) of the crop, confidence (k,) in [0, 1], footprint (k,) of texels; vertices reordered."""
        values = np.column_stack([self.values[order], self.shared]).astype(np.float32)
        at = blend_corners(values[self.face.faces], ids, weights)
        px, height, width = at[:, :2], *self.picture.weight.shape
        column = np.clip(np.rint(px[:, 0]), 0, width - 1).astype(int)
        row = np.clip(np.rint(px[:, 1]), 0, height - 1).astype(int)
        unhidden = ~self.picture.fragments.mask[row, column] | (self.front[row, column] - at[:, 3] < _HIDDEN_MM)
        inside = (px[:, 0] >= 0) & (px[:, 0] <= width - 1) & (px[:, 1] >= 0) & (px[:, 1] <= height - 1)
        confidence = at[:, 2] * at[:, 5] * unhidden * inside
        used = confidence > 0
        confidence[used] *= sample_image(self.picture.weight, px[used])
        return px, confidence, at[:, 4]


def _footprints(face: AlignedFace, picture: FacePicture, size: int) -> np.ndarray:
    """Pixels of the crop (n,) along the side of a texel, the longer way, mean of a vertex's triangles."""
    a, b, c = (picture.points[face.faces[:, k]] for k in range(3))
    atlas = atlas_coordinates(face.model)
    u, v, w = (uv_to_px(atlas.uv, size, size)[atlas.uv_faces[:, k]] for k in range(3))
    texels, pixels = np.stack([v - u, w - u], 2), np.stack([b - a, c - a], 2)
    area = texels[:, 0, 0] * texels[:, 1, 1] - texels[:, 0, 1] * texels[:, 1, 0]
    flat = np.abs(area) < 1e-9
    inverse = np.stack([texels[:, 1, 1], -texels[:, 0, 1], -texels[:, 1, 0], texels[:, 0, 0]], 1).reshape(-1, 2, 2)
    J = pixels @ (inverse / np.where(flat, np.inf, area)[:, None, None])
    square, twice_det = (J**2).sum((1, 2)), 2 * np.abs(np.linalg.det(J))
    longest = 0.5 * (np.sqrt(square + twice_det) + np.sqrt(np.maximum(square - twice_det, 0)))
    corners = face.faces.ravel()
    total = np.bincount(corners, longest.repeat(3), len(face.vertices))
    return np.maximum(total / np.maximum(np.bincount(corners, minlength=len(face.vertices)), 1), 1e-3)


def _calm(face: AlignedFace, rig: Rig) -> np.ndarray:
    """1 (n,) where no expression stretches the skin much, 0 where one enlarges a triangle manyfold, lids left aside."""
    around = face.region("face").copy()
    for side in SIDES:
        if face.model.has(*lids_of(side)):
            around &= ~face.region(f"eye_{side}")
    triangles = face.faces[around[face.faces].all(1)]

    def areas(V: np.ndarray) -> np.ndarray:
        a, b, c = (V[:, triangles[:, k]] for k in range(3))
        u, v = b - a, c - a
        normal = u[[1, 2, 0]] * v[[2, 0, 1]] - u[[2, 0, 1]] * v[[1, 2, 0]]
        return np.sqrt((normal * normal).sum(0))

    # Coordinates in rows and single precision: this looks at every triangle of every expression.
    rest = np.ascontiguousarray(rig.neutral.T, np.float32)
    # A mouth at rest is narrower than it is drawn; what counts is how its drawing is stretched.
    neutral = np.maximum(np.maximum(areas(rest), areas(np.ascontiguousarray(face.vertices.T, np.float32))), 1e-9)
    growth = np.max([areas(rest + delta.T) for delta in rig.deltas], axis=0, initial=0.0) / neutral
    stretch = np.ones(len(rig.neutral))
    np.maximum.at(stretch, triangles.ravel(), growth.repeat(3))
    return 1 - np.clip((stretch - _STRETCH[0]) / (_STRETCH[1] - _STRETCH[0]), 0, 1)
