"""What a drawing is drawn from: everything that is measured on the warped picture, once."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from toongeo.arrays import Floats, Singles
from toongeo.pipeline.parse.masks import filled, grown
from toongeo.pipeline.stylize.appearance.edge_flow import abstracted, line_response
from toongeo.pipeline.stylize.appearance.head_light import HeadLight
from toongeo.pipeline.stylize.appearance.pixels import blurred, enlarged, placed_in, soft_step
from toongeo.pipeline.stylize.appearance.skin_region import SkinRegion, may_be_beard, skin_region
from toongeo.pipeline.stylize.appearance.steep_edges import steep_edges
from toongeo.pipeline.texture.find_rims import Rims

__all__ = ["Subject", "subject_of", "working_factor"]

# px of the face at which pictures are abstracted; edges are cut later, at the picture's own size. Pictures with more
# around the face than these pixels have room for are abstracted at a smaller size.
WORKING_SIZE, _MOST_PIXELS = 104.0, 500_000
_STEEP_RADIUS = 0.012  # face sizes
_NONE = 1e-3  # of cover
# How far colours are off those of skin in its light where they are kept (Lab), less between nose and lip, where a smile
# has no folds, and over how much that begins; the most that light changes lightness for one unit of shade.
_OFF, _OFF_LIP, _SOFT_OFF, _MOST_SHADE = 15.0, 8.0, 3.0, 15.0
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
    rims : Rims or None
        Of glasses.
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
    rims: Rims | None

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
    def unexplained(self) -> Singles:
        """Where a beard may grow, and colours are none that skin has in this light (H, W): beards, moustaches."""
        around, lip = _beard_zone(self)
        known = self.skin.hull * self.skin.seen * (1 - around) > 0.5
        shade, lightness = self.light.shade, self.small[..., 0]
        slope = 0.0
        if known.sum() > 1:
            away = shade[known] - shade[known].mean()
            slope = float(np.clip(away @ lightness[known] / max(float(away @ away), 1e-6), 0, _MOST_SHADE))
        expected = self.skin.median[0] + slope * (shade - (np.median(shade[known]) if known.any() else 0))
        off = np.square(lightness - expected) + np.square(self.small[..., 1:] - self.skin.median[1:]).sum(axis=-1)
        kept = around * soft_step(np.sqrt(off) - np.float32(_OFF) + np.float32(_OFF - _OFF_LIP) * lip, _SOFT_OFF)
        return self.full(np.asarray(blurred(kept.astype(np.float32), 0.012 * self.size * self.factor)))

    @cached_property
    def skin_box(self) -> tuple[slice, slice]:
        """Rows and columns of the drawing outside which nothing is painted as skin."""
        x, y, width, height = cv2.boundingRect((self.skin_cover > _NONE).astype(np.uint8))
        return slice(y, y + height), slice(x, x + width)


def _beard_zone(subject: Subject) -> tuple[Singles, Singles]:
    """Soft covers (h, w) of where beards and moustaches grow, and of what of it is between nose and lip."""
    points, size = placed_in(subject.landmarks, subject.factor), subject.size * subject.factor
    shape = subject.small.shape
    nose = grown(filled(shape, points[31:36]), 0.01 * size)
    beard = may_be_beard(shape, points, size) & ~nose
    lip = filled(shape, points[[31, 33, 35, 54, 53, 52, 51, 50, 49, 48]]) & ~nose
    return tuple(blurred(zone.astype(np.float32), 0.015 * size) for zone in (beard, lip))  # type: ignore[return-value]


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
    rims: Rims | None,
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
    return Subject(shape, landmarks, size, irises, factor, seen, small, flow, lines, lab, hair, skin, light, grey, rims)
