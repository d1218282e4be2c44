"""Lids that can close.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

import cv2
import numpy as np

from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.texture.lids.lash_line import drawn_lashes, stroked
from toongeo.pipeline.texture.lids.lid_membrane import lid_membrane
from toongeo.pipeline.texture.lids.lid_zones import lid_zone, skin_edges
from toongeo.pipeline.texture.vertex_colours import vertex_colours
from toongeo.render import Fragments
from toongeo.render.interpolate import blend_corners

__all__ = ["paint_lids"]

_BLUR = 1.2 / 512  # of the atlas: s.d. of the blur through which the skin around a lid is seen


def paint_lids(texture: np.ndarray, atlas: Fragments, img: np.ndarray, face: AlignedFace, rig: Rig) -> np.ndarray:
    """A texture whose lids are plain skin with a line of lashes along their edge.

    An open eye shows a strip of its upper lid, with lashes and shadow, that a blink draws over the whole eye. What is
    stretched so takes the colour of the skin around the eye, and the line at the edge is drawn anew, as thick as ever.

    Parameters
    ----------
    texture : (size, size, 3) uint8 RGB
    atlas : Fragments
        Triangles of its texels.
    img : (H, W, 3) uint8 RGB
        The picture, for the colour of the lashes.
    face : AlignedFace
        As in the picture.
    rig : Rig
        Its blinks tell which skin is a lid's.

    Returns
    -------
    (size, size, 3) uint8 RGB
    """
    model, size = face.model, len(texture)
    edges = skin_edges(model)
    zones = {side: zone for side in SIDES if (zone := lid_zone(model, rig, side, edges)) is not None}
    if not zones:
        return texture
    colours = vertex_colours(model, cv2.GaussianBlur(texture, (0, 0), _BLUR * size))
    painted = texture.astype(np.float32)
    for side, zone in zones.items():
        closed = rig.neutral + rig.deltas[rig.names.index(f"eyeBlink{side.capitalize()}")]
        skin = lid_membrane(model, side, zone, edges, colours, closed)
        touched = (zone[model.faces] > 0).any(1)
        texels = np.flatnonzero(atlas.mask & touched[atlas.face_ids])
        ids, weights = atlas.face_ids.ravel()[texels], atlas.barycentrics.reshape(-1, 3)[texels]
        values = np.column_stack([skin, zone]).astype(np.float32)
        at = blend_corners(values[model.faces], ids, weights)
        share = (at[:, 3] ** 2 * (3 - 2 * at[:, 3]))[:, None]
        flat = painted.reshape(-1, 3)
        flat[texels] += share * (at[:, :3] - flat[texels])
        painted = stroked(painted, model, rig.neutral, side, drawn_lashes(img, face, side, skin))
    return np.clip(np.rint(painted), 0, 255).astype(np.uint8)
