"""The skin painted on the chart of the template: complexion, wrinkles, beard, and (by `feature_paint`) its features."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from renders.canvas import Canvas, between, smooth_noise
from renders.feature_paint import paint_brows, paint_eyes, paint_lips, paint_nose
from renders.palette import Palette
from renders.template import template

__all__ = ["painted_skin"]


def painted_skin(
    rng: np.random.Generator, palette: Palette, plain: bool
) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """A chart (h, w, 3) float32, 0-255, and the ten brow landmarks (10, 2) px on it; `plain` has no texture."""
    points = template().landmarks
    height, width = template().chart_shape
    mottle = np.zeros((height, width), np.float32)
    if not plain:
        for knots, most in ((7, 9), (60, 6), (200, 5)):
            mottle += smooth_noise(rng, height, width, knots) * np.float32(between(rng, 0, most))
    chart = mottle[..., None] + palette.skin.astype(np.float32)
    canvas = Canvas(chart)
    _paint_cheeks(rng, canvas, points, palette)
    if rng.random() < 0.33:
        _paint_beard(rng, canvas, points, palette)
    if rng.random() < 0.25:
        _paint_moustache(rng, canvas, points, palette)
    paint_lips(rng, canvas, points, palette)
    brows = paint_brows(rng, canvas, points, palette, plain)
    paint_eyes(rng, canvas, points, palette)
    paint_nose(rng, canvas, points, palette)
    _paint_wrinkles(rng, canvas, points, brows, palette)
    return chart, brows


def _paint_cheeks(rng, canvas: Canvas, points, palette: Palette) -> None:
    for side in (-1, 1):
        centre = points[27, 0] + side * between(rng, 45, 62), points[30, 1] + between(rng, -8, 10)
        canvas.ellipse(centre, (20, 14), palette.skin * [1.02, 0.75, 0.72], between(rng, 0, 0.5), 9)


def _paint_beard(rng, canvas: Canvas, points, palette: Palette) -> None:
    """Stubble, a full beard or a goatee."""
    low, high = between(rng, -25, 5), between(rng, -25, 5)
    inner = points[[54, 35, 33, 31, 48]] + [[14, high], [4, 6], [0, 8], [-4, 6], [-14, low]]
    ring = np.vstack([points[2:15] + [0, 25], inner])
    if rng.random() < 0.4:
        canvas.fill(ring, palette.hair, between(rng, 0.15, 0.5), 8)
        return
    if rng.random() < 0.5:
        ring = np.vstack([points[5:12] + [0, 30], points[54] + [10, 0], points[56:59], points[48] - [10, 0]])
    canvas.fill(ring, palette.hair, between(rng, 0.6, 1), between(rng, 2, 6))
    for _ in range(int(rng.integers(0, 120))):
        root = ring[rng.integers(len(ring), size=2)].mean(0)
        tip = root + rng.normal(0, 3, 2) + [0, between(rng, 4, 14)]
        canvas.stroke([root, tip], palette.hair * between(rng, 0.5, 1.5), between(rng, 0.3, 0.9), 1, 0.4)


def _paint_moustache(rng, canvas: Canvas, points, palette: Palette) -> None:
    extra, top = between(rng, -6, 14), points[33, 1] + between(rng, 5, 10)
    low = points[51, 1] - between(rng, -2, 4)
    x = np.linspace(points[48, 0] - extra, points[54, 0] + extra, 9)
    droop = ((x - points[27, 0]) / (points[54, 0] - points[27, 0])) ** 2 * between(rng, 0, 18)
    thick = np.sin(np.linspace(0.15, np.pi - 0.15, 9)) * (low - top)
    upper, lower = np.column_stack([x, low + droop - thick]), np.column_stack([x, low + droop + 2])
    canvas.fill(np.vstack([upper, lower[::-1]]), palette.hair, between(rng, 0.6, 1), between(rng, 0.6, 2.5))


def _paint_wrinkles(rng, canvas: Canvas, points, brows, palette: Palette) -> None:
    skin, middle = palette.skin, points[27, 0]
    if rng.random() < 0.6:  # from the nose to the corners of the mouth
        for wing, corner, side in ((31, 48, -1), (35, 54, 1)):
            start, end = (
                points[wing] + [7 * side, -5],
                points[corner] + [side * between(rng, 3, 12), between(rng, -3, 10)],
            )
            bend = (points[wing] + points[corner]) / 2 + [side * between(rng, 8, 16), 0]
            shade = skin * between(rng, 0.45, 0.75)
            canvas.stroke([start, bend, end], shade, between(rng, 0.1, 0.9), rng.integers(1, 4), between(rng, 0.6, 2))
    if rng.random() < 0.4:  # forehead
        for k in range(int(rng.integers(1, 5))):
            reach = between(rng, 25, 60)
            x = middle + reach * np.linspace(-1, 1, 5)
            y = brows[:, 1].min() - 15 - 14 * k + rng.normal(0, 2.5, 5)
            canvas.stroke(np.column_stack([x, y]), skin * 0.6, between(rng, 0.1, 0.7), rng.integers(1, 3), 1)
    if rng.random() < 0.3:  # frown
        eye_line = points[36:48, 1].mean()
        for side in (-1, 1):
            line = [[middle + 6 * side, eye_line - 26], [middle + side * between(rng, 4, 8), eye_line - 8]]
            canvas.stroke(line, skin * 0.5, between(rng, 0.2, 0.8), 1, 0.8)
    if rng.random() < 0.4:  # under the lower lip
        line = points[57] + [[-14, 12], [0, 9], [14, 12]]
        canvas.stroke(line, skin * 0.6, between(rng, 0.1, 0.7), rng.integers(2, 6), 2)
    if rng.random() < 0.2:  # freckles, moles
        for _ in range(int(rng.integers(3, 60))):
            place = between(rng, points[1, 0], points[15, 0]), between(rng, points[36, 1] - 60, points[8, 1])
            spot = skin * between(rng, 0.5, 0.8)
            canvas.stroke([place, place], spot, between(rng, 0.2, 0.8), rng.integers(1, 4), 0.5)
