"""A picture that is painted on."""

import cv2
import numpy as np
from numpy.typing import ArrayLike

from toongeo.arrays import Floats, Singles
from toongeo.pipeline.stylize.appearance.pixels import blurred, rgb_of

__all__ = ["Canvas", "colour"]

_FINER = 4  # subpixels a side: OpenCV's own antialiasing leaves stairs
_SUBPIXELS = 4  # bits of a corner's place


def colour(lightness: float, a: float = 0.0, b: float = 0.0) -> Singles:
    """RGB (3,) in 0..255 of a CIELAB colour."""
    return np.asarray(rgb_of(np.array([[[lightness, a, b]]], np.float32))[0, 0])


class Canvas:
    """Shapes are painted over each other, antialiased, each only within its own box.

    Attributes
    ----------
    rgb : (h, w, 3) float32, 0..255
    """

    def __init__(self, rgb: Singles) -> None:
        self.rgb = np.array(rgb, np.float32)

    def cover(self, cover: Singles, paint: ArrayLike, strength: float = 1.0) -> None:
        """Paint where a cover (h, w) in [0, 1] is; ``paint`` is a colour (3,) or a picture (h, w, 3)."""
        x, y, width, height = cv2.boundingRect((cover > 0.004).astype(np.uint8))
        box = np.s_[y : y + height, x : x + width]
        paint = np.asarray(paint, np.float32)
        self._blend(box, cover[box] * np.float32(strength), paint[box] if paint.ndim == 3 else paint)

    def polygon(
        self,
        outline: Floats,
        paint: ArrayLike,
        strength: float = 1.0,
        softness: float = 0.0,
        within: Singles | None = None,
    ) -> None:
        """Fill an outline (k, 2) px; ``softness`` is the sigma of its edge, ``within`` a cover (h, w) times it."""
        self._paint([outline], paint, strength, softness, within)

    def ribbon(
        self,
        line: Floats,
        half_width: ArrayLike,
        paint: ArrayLike,
        strength: float = 1.0,
        softness: float = 0.0,
        within: Singles | None = None,
    ) -> None:
        """A line (k, 2) px with half its width at each point, px."""
        along = np.gradient(line, axis=0)
        normal = np.stack([-along[:, 1], along[:, 0]], axis=1)
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
        half = np.broadcast_to(np.asarray(half_width, np.float64), len(line))[:, None]
        one, other = line - half * normal, line + half * normal
        pieces = np.stack([one[:-1], one[1:], other[1:], other[:-1]], axis=1)  # by themselves: bends do not cancel out
        self._paint(list(pieces), paint, strength, softness, within)

    def shape_of(self, *outlines: Floats, softness: float = 0.0) -> tuple[tuple[slice, slice], Singles]:
        """Box around outlines (k, 2) px in the picture, and their cover there."""
        points = np.concatenate(outlines)
        margin = 2 + int(np.ceil(3 * softness))
        low = np.maximum(np.floor(points.min(axis=0)).astype(int) - margin, 0)
        high = np.minimum(np.ceil(points.max(axis=0)).astype(int) + margin + 1, self.rgb.shape[1::-1])
        width, height = np.maximum(high - low, 0)
        box = np.s_[low[1] : low[1] + height, low[0] : low[0] + width]
        if not width * height:
            return box, np.zeros((height, width), np.float32)
        layer = np.zeros((_FINER * height, _FINER * width), np.uint8)
        for outline in outlines:
            corners = ((outline - low + 0.5) * _FINER - 0.5) * 2**_SUBPIXELS
            cv2.fillPoly(layer, [np.rint(corners).astype(np.int32)], 255, cv2.LINE_8, _SUBPIXELS)
        cover = np.asarray(cv2.resize(layer, (width, height), interpolation=cv2.INTER_AREA), np.float32) / np.float32(
            255
        )
        return box, blurred(cover, softness) if softness > 0 else cover

    def _paint(
        self, outlines: list[Floats], paint: ArrayLike, strength: float, softness: float, within: Singles | None
    ) -> None:
        box, cover = self.shape_of(*outlines, softness=softness)
        if cover.size:
            cover = cover * np.float32(strength) * (1 if within is None else within[box])
            self._blend(box, cover, np.asarray(paint, np.float32))

    def _blend(self, box: tuple[slice, slice], cover: Singles, paint: Singles) -> None:
        part = self.rgb[box]
        part += cover[..., None] * (paint - part)
