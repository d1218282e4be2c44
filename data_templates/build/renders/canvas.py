"""Painting on a picture of floats, and noise."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["Canvas", "between", "fractal_noise", "smooth_noise"]

_SHIFT = 3  # OpenCV draws at 1/8 px


class Canvas:
    """A picture (h, w, 3) float32, 0-255, that polygons and strokes are painted onto.

    `labels` (h, w) uint8, if given, is written wherever paint covers at least half of a pixel and a `label` is named.
    """

    def __init__(self, picture: NDArray[np.float32], labels: NDArray[np.uint8] | None = None) -> None:
        self.picture = picture
        self.labels = labels

    def fill(self, points: ArrayLike, colour: ArrayLike, opacity: float = 1.0, blur: float = 0.0, label=None) -> None:
        """Fill the polygon `points` (k, 2) px; `blur` is the standard deviation of its edge in px."""
        self._paint(points, colour, opacity, blur, 0, label, lambda mask, p: cv2.fillPoly(mask, [p], 1, 16, _SHIFT))

    def stroke(
        self,
        points: ArrayLike,
        colour: ArrayLike,
        opacity: float = 1.0,
        width: float = 1,
        blur: float = 0.0,
        closed: bool = False,
        label=None,
    ) -> None:
        """Draw the line through `points` (k, 2) px."""
        thick = max(1, round(width))
        self._paint(
            points,
            colour,
            opacity,
            blur,
            thick,
            label,
            lambda mask, p: cv2.polylines(mask, [p], closed, 1, thick, 16, _SHIFT),
        )

    def ellipse(self, centre: ArrayLike, axes: ArrayLike, colour: ArrayLike, opacity: float = 1.0, blur: float = 0.0):
        """Fill an upright ellipse with half axes `axes` (2,) px."""
        angles = np.linspace(0, 2 * np.pi, 20, endpoint=False)
        ring = np.asarray(centre) + np.column_stack([np.cos(angles), np.sin(angles)]) * axes
        self.fill(ring, colour, opacity, blur)

    def _paint(self, points, colour, opacity, blur, thick, label, draw) -> None:
        points = np.asarray(points, float)
        height, width = self.picture.shape[:2]
        pad = int(3 * blur + thick + 3)
        x0, y0 = np.maximum(np.floor(points.min(0)).astype(int) - pad, 0)
        x1, y1 = np.minimum(np.ceil(points.max(0)).astype(int) + pad, [width, height])
        if x1 <= x0 or y1 <= y0:
            return
        mask = np.zeros((y1 - y0, x1 - x0), np.float32)
        draw(mask, np.rint((points - [x0, y0]) * 2**_SHIFT).astype(np.int32))
        if blur > 0.3:
            mask = cv2.GaussianBlur(mask, (0, 0), blur)
        weight = mask[..., None] * np.float32(opacity)
        part = self.picture[y0:y1, x0:x1]
        part += weight * (np.asarray(colour, np.float32) - part)
        if label is not None and self.labels is not None:
            self.labels[y0:y1, x0:x1][mask >= 0.5] = label


def smooth_noise(rng: np.random.Generator, height: int, width: int, knots: int) -> NDArray[np.float32]:
    """Normal noise at knots x knots places, interpolated smoothly to (height, width)."""
    values = rng.normal(size=(knots, knots)).astype(np.float32)
    return cv2.resize(values, (width, height), interpolation=cv2.INTER_CUBIC)


def fractal_noise(rng: np.random.Generator, height: int, width: int) -> NDArray[np.float32]:
    """Sum of smooth noises of ever finer knots: clouds, plaster, foliage."""
    total, knots, weight = np.zeros((height, width), np.float32), 3, 1.0
    while knots < height:
        total += weight * smooth_noise(rng, height, width, knots)
        knots, weight = 2 * knots, weight * rng.uniform(0.4, 0.75)
    return total


def between(rng: np.random.Generator, low: float, high: float) -> float:
    """A uniform number; short for what the painters need in every line."""
    return float(rng.uniform(low, high))
