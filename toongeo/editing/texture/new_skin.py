"""What an expression brings to light that the picture does not show."""

from __future__ import annotations

import numpy as np

from toongeo.editing.texture.lid_skin import LINE, lash_colour, lid_zones
from toongeo.editing.texture.openings import jaw_moved, lid_closing, lips_parted
from toongeo.editing.texture.picture_warp import Stroke
from toongeo.geometry import vertex_normals
from toongeo.model import MorphableModel
from toongeo.model.anatomy.lid_rings import lid_rings
from toongeo.model.anatomy.parts import MOUTH_PARTS, SIDES
from toongeo.pipeline import Rig
from toongeo.pipeline.texture.vertex_colours import vertex_colours
from toongeo.protocols import TextureGeometry

__all__ = ["NewSkin"]

_INWARD = 0.35  # cosine to the front below which a lip is its inner side
_MOVED = 0.12  # of the mouth's width: a jaw that has moved so much shows another mouth than the picture
_FAINT = 0.02  # less of a line is not seen


class NewSkin:
    """Where a face shows the skin of a closing lid, the inner side of its lips, and the line of its lashes.

    By the geometry alone: it is the same whoever makes the texture.

    Parameters
    ----------
    model : MorphableModel
    rig : Rig
        Its blinks tell which skin is a lid's.
    texture : (S, S, 3) uint8 RGB
        Atlas, which shows the colour of lashes.

    Attributes
    ----------
    zones : (2, n) float32
        How far a vertex shows new skin when the left, or right, eye closes.
    inner : (n,) bool
        Cavity, teeth and tongue.
    lower : (n,) bool
        Of these, what a jaw moves or shows.
    inner_lip : (n,) bool
        The side of the lips that is turned inwards.
    fresh : (n,) float32
        1 for both.
    colours : (n, 3) float32, 0-255
        Of the texture at the vertices.
    skin : (n,) bool
        Plain skin of the face that is turned to the front: no lips, brows, or surroundings of the eyes.
    lash_colour : (3,) float32, 0-255
    """

    def __init__(self, model: MorphableModel, rig: Rig, texture: np.ndarray) -> None:
        self.model = model
        front = vertex_normals(rig.neutral, model.faces)[:, 2]
        self.colours = vertex_colours(model, texture)
        eyes = model.region("eye_left") | model.region("eye_right")
        brows = model.region("brow_left") | model.region("brow_right")
        self.skin = model.region("face") & ~model.region("lips") & ~eyes & ~brows & (front > 0)
        self.zones = lid_zones(model, rig)
        self.inner = np.any([model.region(name) for name in MOUTH_PARTS], axis=0)
        self.lower = self.inner & ~model.region("teeth_upper")
        self.inner_lip = model.region("lips") & (front < _INWARD) & ~self.inner
        self.fresh = (self.inner | self.inner_lip).astype(np.float32)
        self.lash_colour = lash_colour(model, self.colours, self.skin).astype(np.float32)

    def shown(self, closing: np.ndarray, parted: float) -> np.ndarray:
        """How far (n,) a vertex shows it, for how far (2,) the eyes close and the lips are parted."""
        lids = np.maximum(closing[0] * self.zones[0], closing[1] * self.zones[1])
        return np.asarray(np.maximum(lids, parted * self.fresh), np.float32)

    def renewed(self, geometry: TextureGeometry) -> np.ndarray:
        """How far (n,) in [0, 1] a vertex shows what the source does not: skin of a closing lid, inner lips."""
        closing = lid_closing(self.model, geometry.source, geometry.target)
        parting = lips_parted(self.model, geometry.target) * (1 - lips_parted(self.model, geometry.source))
        # Of teeth and tongue the picture may show some already. That stays until the jaw has moved: stretched, or seen
        # from another side, it would be scraps.
        moved = float(np.clip(jaw_moved(self.model, geometry.source, geometry.target) / _MOVED, 0, 1))
        return np.where(self.inner, moved * self.lower, self.shown(closing, parting)).astype(np.float32)

    def lash_strokes(self, geometry: TextureGeometry) -> list[Stroke]:
        """The line along each lid that closes, for pictures, where it should be as sharp as the drawing's own."""
        closing = lid_closing(self.model, geometry.source, geometry.target)
        return [
            Stroke(lid_rings(self.model, name).upper[2], self.lash_colour, LINE, float(strength))
            for name, strength in zip(SIDES, closing, strict=True)
            if strength > _FAINT
        ]
