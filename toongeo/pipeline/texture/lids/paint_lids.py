"""Lids that can close.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

import cv2
import numpy as np

from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline.align.align_face import AlignedFace
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.texture.lids.lash_line import drawn_lashes, spike_count, stroked
from toongeo.pipeline.texture.lids.lid_membrane import lid_membrane
from toongeo.pipeline.texture.lids.lid_zones import lid_zone, skin_edges
from toongeo.pipeline.texture.vertex_colours import vertex_colours
from toongeo.render import Fragments
from toongeo.render.interpolate import blend_corners

__all__ = ["paint_lids"]

_SPIKY = 6  # strokes along a lid that are lashes drawn one by one; pictures without have at most 4
_SMEARED = (2.2, 3.5)  # growth of a triangle's area in a blink: spikes drawn there are not kept, the more it grows
_STROKE = 0.012  # of the atlas: what is broader is no stroke but shadow
_FAINT, _CLEAR = 12.0, 32.0  # of 255: by how much a stroke is darker than what it is drawn on
_BLUR = 1.2 / 512  # of the atlas: s.d. of the blur through which the skin around a lid is seen


def paint_lids(texture: np.ndarray, atlas: Fragments, img: np.ndarray, face: AlignedFace, rig: Rig) -> np.ndarray:
    """A texture whose lids are plain skin with a line of lashes along their edge.

    Spikes of lashes that are drawn above the eye stay where a blink does not smear them over it.

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
    strokes = _strokes(texture)
    painted = texture.astype(np.float32)
    for side, zone in zones.items():
        closed = rig.neutral + rig.deltas[rig.names.index(f"eyeBlink{side.capitalize()}")]
        strip = lid_zone(model, rig, side, edges, _SMEARED)
        skin = lid_membrane(model, side, zone, edges, colours, closed)
        touched = (zone[model.faces] > 0).any(1)
        texels = np.flatnonzero(atlas.mask & touched[atlas.face_ids])
        ids, weights = atlas.face_ids.ravel()[texels], atlas.barycentrics.reshape(-1, 3)[texels]
        reach = np.zeros_like(zone) if strip is None else strip
        values = np.column_stack([skin, zone, reach]).astype(np.float32)
        at = blend_corners(values[model.faces], ids, weights)
        share = at[:, 3] ** 2 * (3 - 2 * at[:, 3])
        if spike_count(img, face, side, skin) >= _SPIKY:
            share *= 1 - strokes.ravel()[texels] * (1 - at[:, 4])
        share = share[:, None]
        flat = painted.reshape(-1, 3)
        flat[texels] += share * (at[:, :3] - flat[texels])
        painted = stroked(painted, model, rig.neutral, side, drawn_lashes(img, face, side, skin))
    return np.clip(np.rint(painted), 0, 255).astype(np.uint8)


def _strokes(texture: np.ndarray) -> np.ndarray:
    """How far (size, size) each texel is part of a thin dark stroke."""
    light = cv2.cvtColor(texture, cv2.COLOR_RGB2GRAY)
    width = 1 + 2 * max(1, round(_STROKE / 2 * len(texture)))
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (width, width))
    dark = np.asarray(cv2.morphologyEx(light, cv2.MORPH_BLACKHAT, disc), np.float32)
    return np.clip((dark - _FAINT) / (_CLEAR - _FAINT), 0, 1)
