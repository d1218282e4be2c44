"""What a drawing is drawn from: everything that is measured on the warped picture, once."""

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Bytes, Floats, Singles
from toongeo.colour.cielab import cielab
from toongeo.pipeline.stylize.appearance.edge_flow import abstracted, line_response
from toongeo.pipeline.stylize.appearance.head_light import HeadLight
from toongeo.pipeline.stylize.appearance.pixels import enlarged, placed_in, reduced
from toongeo.pipeline.stylize.appearance.skin_region import SkinRegion, skin_region
from toongeo.pipeline.stylize.appearance.steep_edges import steep_edges

__all__ = ["WORKING_SIZE", "Subject", "subject_of"]

WORKING_SIZE = 130.0  # px of the face at which pictures are abstracted; edges are cut later, at the picture's own size
_STEEP_RADIUS = 0.012  # face sizes
_GREY = 1.0  # mean absolute a* and b* below which a picture has no colour


@dataclass(frozen=True, eq=False)
class Subject:
    """A face to be drawn. Planes of skin and light are of the reduced picture: :meth:`full` enlarges them.

    Attributes
    ----------
    picture : (H, W, 3) uint8 RGB
    landmarks : (68, 2) float, px
    size : float, px
        Of the face.
    irises : tuple of (2,) float px, or None
        Of the points 36-41 and of 42-47.
    factor : float
        Of the reduced picture.
    small, flow : (h, w, 3) and (h, w, 2) float32
        The abstracted picture in CIELAB, reduced, and the flow along its edges.
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

    picture: Bytes
    landmarks: Floats
    size: float
    irises: tuple[Floats | None, Floats | None]
    factor: float
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
        return np.clip(enlarged(plane, self.picture.shape), 0, 1)


def subject_of(
    picture: Bytes,
    landmarks: Floats,
    size: float,
    light: HeadLight,
    hair: Singles,
    irises: tuple[Floats | None, Floats | None],
    *,
    passes: int,
    tolerance: float,
) -> Subject:
    """Abstract a warped picture and find its skin; ``light`` and ``hair`` (h, w) are of the reduced picture."""
    factor = WORKING_SIZE / size
    small, flow = abstracted(reduced(cielab(picture), factor), size * factor, passes, tolerance)
    lines = line_response(small[..., 0], flow, size * factor)
    skin = skin_region(small, placed_in(landmarks, factor), size * factor, light, hair)
    lab = steep_edges(enlarged(small, picture.shape), max(1, round(_STEEP_RADIUS * size)))
    grey = bool(np.abs(small[..., 1:]).mean() < _GREY)
    return Subject(picture, landmarks, size, irises, factor, small, flow, lines, lab, hair, skin, light, grey)
