"""What a drawing is drawn from: everything that is measured on the warped picture, once."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from toongeo.arrays import Floats, Singles
from toongeo.pipeline.stylize.appearance.edge_flow import abstracted, line_response
from toongeo.pipeline.stylize.appearance.head_light import HeadLight
from toongeo.pipeline.stylize.appearance.pixels import enlarged, placed_in
from toongeo.pipeline.stylize.appearance.skin_region import SkinRegion, skin_region
from toongeo.pipeline.stylize.appearance.steep_edges import steep_edges

__all__ = ["Subject", "subject_of", "working_factor"]

# px of the face at which pictures are abstracted; edges are cut later, at the picture's own size. Pictures with more
# around the face than these pixels have room for are abstracted at a smaller size.
WORKING_SIZE, _MOST_PIXELS = 104.0, 500_000
_STEEP_RADIUS = 0.012  # face sizes
_NONE = 1e-3  # of cover
_GREY = 1.0  # mean absolute a* and b* below which a picture has no colour


@dataclass(frozen=True, eq=False)
class Subject:
    """A face to be drawn. Planes of skin and light are of the reduced picture: :meth:`full` enlarges them.

    Attributes
    ----------
    shape : (H, W)
        Of the drawing.
    landmarks : (68, 2) float, px
    size : float, px
        Of the face.
    irises : tuple of (2,) float px, or None
        Of the points 36-41 and of 42-47.
    factor : float
        Of the reduced picture.
    seen, small, flow : (h, w, 3), (h, w, 3) and (h, w, 2) float32
        The warped picture in CIELAB, reduced; the same abstracted, and the flow along its edges.
    lines : (h, w) float32
        How much darker than its sides each pixel is, along the flow, L*.
    lab : (H, W, 3) float32
        The same at full size, with steep edges.
    hair : (h, w) float32
        How surely a pixel is hair or a hat.
    skin : SkinRegion
    light : HeadLight
    grey : bool
        Without colours.
    """

    shape: tuple[int, int]
    landmarks: Floats
    size: float
    irises: tuple[Floats | None, Floats | None]
    factor: float
    seen: Singles
    small: Singles
    flow: Singles
    lines: Singles
    lab: Singles
    hair: Singles
    skin: SkinRegion
    light: HeadLight
    grey: bool

    def full(self, plane: Singles) -> Singles:
        """A plane in [0, 1] of the reduced picture at full size."""
        return np.clip(enlarged(plane, self.shape), 0, 1)

    @cached_property
    def skin_cover(self) -> Singles:
        """What is painted as skin (H, W)."""
        return self.full(self.skin.drawn)

    @cached_property
    def hull(self) -> Singles:
        """Between jaw and brows (H, W)."""
        return self.full(self.skin.hull)

    @cached_property
    def response(self) -> Singles:
        """`lines` at full size (H, W)."""
        return np.clip(enlarged(self.lines, self.shape), -50, 50)

    @cached_property
    def skin_box(self) -> tuple[slice, slice]:
        """Rows and columns of the drawing outside which nothing is painted as skin."""
        x, y, width, height = cv2.boundingRect((self.skin_cover > _NONE).astype(np.uint8))
        return slice(y, y + height), slice(x, x + width)


def working_factor(shape: tuple[int, int], size: float) -> float:
    """By which a picture (H, W) is reduced whose face has a size in px."""
    return float(min(WORKING_SIZE / size, np.sqrt(_MOST_PIXELS / (shape[0] * shape[1]))))


def subject_of(
    shape: tuple[int, int],
    seen: Singles,
    landmarks: Floats,
    size: float,
    light: HeadLight,
    hair: Singles,
    irises: tuple[Floats | None, Floats | None],
    *,
    passes: int,
    tolerance: float,
) -> Subject:
    """Abstract a warped picture and find its skin; ``seen`` (CIELAB), ``light`` and ``hair`` (h, w) are reduced."""
    factor = working_factor(shape, size)
    small, flow, along = abstracted(seen, size * factor, passes, tolerance)
    lines = line_response(small[..., 0], along, size * factor)
    skin = skin_region(small, placed_in(landmarks, factor), size * factor, light, hair)
    lab = steep_edges(enlarged(small, shape), max(1, round(_STEEP_RADIUS * size)))
    grey = bool(np.abs(small[..., 1:]).mean() < _GREY)
    return Subject(shape, landmarks, size, irises, factor, seen, small, flow, lines, lab, hair, skin, light, grey)
