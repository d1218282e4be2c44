"""Brows, lids, lips and nostrils painted on the chart."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from renders.canvas import Canvas, between
from renders.palette import Palette

__all__ = ["paint_brows", "paint_eyes", "paint_lips", "paint_nose"]

_UPPER_LIDS, _LOWER_LIDS = ((36, 37, 38, 39), (42, 43, 44, 45)), ((39, 40, 41, 36), (45, 46, 47, 42))
_LASH = np.array([20.0, 15.0, 15.0])


def paint_lips(rng: np.random.Generator, canvas: Canvas, points: NDArray[np.float64], palette: Palette) -> None:
    """Lips, the line between them, and sometimes their outline."""
    lips = palette.lips
    canvas.fill(points[48:60], lips, between(rng, 0.25, 1), between(rng, 0.8, 1.8))
    if rng.random() < 0.5:
        lower = points[[54, 55, 56, 57, 58, 59, 48, 60, 67, 66, 65, 64]]
        canvas.fill(lower, np.clip(lips * 1.15, 0, 255), between(rng, 0, 0.7), 1.5)
    canvas.stroke(points[60:65], lips * 0.35, between(rng, 0.3, 1), rng.integers(1, 3), 0.6)
    if rng.random() < 0.4:
        canvas.stroke(points[48:60], lips * 0.5, between(rng, 0.2, 0.8), 1, 0.7, closed=True)


def paint_brows(
    rng: np.random.Generator, canvas: Canvas, points: NDArray[np.float64], palette: Palette, plain: bool
) -> NDArray[np.float64]:
    """Brows of any height, arch, tilt and thickness; their ten landmarks (10, 2) px, on the upper half of the hair.

    Annotators follow the drawn brow, which need not lie where the bone has it.
    """
    brows = points[17:27].copy()
    drop, arch, tilt = between(rng, -7, 3), rng.normal(0, 3), rng.normal(0, 3)
    length, thick, shown = between(rng, 0.88, 1.12), between(rng, 3.5, 13), rng.random() < 0.95
    for side, rows in ((-1, slice(0, 5)), (1, slice(5, 10))):
        middle = brows[rows].mean(0)
        rise = -arch * np.array([0, 0.5, 1, 0.5, 0]) - side * tilt * np.linspace(-1, 1, 5) + drop + rng.normal(0, 1.2)
        line = (brows[rows] - middle) * [length, 1] + middle + np.column_stack([np.zeros(5), rise])
        brows[rows] = line
        if not shown:
            continue
        profile = np.array([0.45, 0.8, 1, 1, 0.8])[::-side] * thick
        top, bottom = line - np.outer(profile, [0, 0.42]), line + np.outer(profile, [0, 0.58])
        canvas.fill(np.vstack([top, bottom[::-1]]), palette.brows, between(rng, 0.45, 1), between(rng, 0.6, 2.2))
        for _ in range(0 if plain else int(rng.integers(0, 45))):
            place = between(rng, 0, 3.99)
            k, rest = int(place), place % 1
            root = line[k] * (1 - rest) + line[k + 1] * rest + [0, between(rng, -0.4, 0.6) * thick]
            tip = root + [side * between(rng, 2, 8), between(rng, -6, 1)]
            canvas.stroke([root, tip], palette.brows * between(rng, 0.5, 1.2), between(rng, 0.3, 0.9), 1, 0.35)
    return brows


def paint_eyes(rng: np.random.Generator, canvas: Canvas, points: NDArray[np.float64], palette: Palette) -> None:
    """Shade of the sockets, creases, bags, lashes and make-up."""
    skin, strength = palette.skin, between(rng, 0.3, 1)
    for upper_ids, lower_ids in zip(_UPPER_LIDS, _LOWER_LIDS, strict=True):
        upper, lower = points[list(upper_ids)], points[list(lower_ids)]
        socket = np.vstack([upper - [0, between(rng, 3, 16)], lower + [0, between(rng, 2, 8)]])
        canvas.fill(socket, skin * between(rng, 0.55, 1), between(rng, 0, 0.8), 4)
        crease = upper - np.outer([0.3, 1, 1, 0.3], [0, between(rng, 4, 9)])
        canvas.stroke(crease, skin * between(rng, 0.4, 0.7), between(rng, 0.1, 0.9), rng.integers(1, 3), 0.8)
        bag = lower + np.outer([1, 1.4, 1.4, 1], [0, between(rng, 5, 14)])
        canvas.stroke(bag, skin * between(rng, 0.5, 0.85), between(rng, 0, 0.8), rng.integers(1, 4), 1.5)
        lash = np.minimum(palette.hair * 0.35, 60)
        canvas.stroke(upper, lash, strength, rng.integers(1, 6), between(rng, 0.4, 1.2))
        if rng.random() < 0.7:
            canvas.stroke(lower, lash * 1.4, strength * between(rng, 0, 0.8), rng.integers(1, 3), 0.7)
        if rng.random() < 0.3:  # a wing at the outer corner
            side, outer = (-1, upper[0]) if upper_ids[0] == 36 else (1, upper[3])
            wing = [outer, outer + [6 * side, -between(rng, 0, 5)]]
            canvas.stroke(wing, _LASH, between(rng, 0.4, 1), rng.integers(1, 4), 0.5)
        if rng.random() < 0.12:
            shadow = np.vstack([upper - [0, 8], lower])
            canvas.fill(shadow, rng.uniform(20, 200, 3), between(rng, 0.2, 0.7), 3)


def paint_nose(rng: np.random.Generator, canvas: Canvas, points: NDArray[np.float64], palette: Palette) -> None:
    """Nostrils, the base, the wings and the side of the bridge."""
    skin = palette.skin
    for k, side in ((32, -1), (34, 1)):
        axes = between(rng, 3, 6), between(rng, 1.5, 3.5)
        canvas.ellipse(points[k] + [2.5 * side, -2], axes, skin * 0.25, between(rng, 0.3, 1), 0.9)
    shade = skin * between(rng, 0.35, 0.7)
    canvas.stroke(points[31:36] + [0, 1], shade, between(rng, 0.1, 0.8), rng.integers(1, 3), 1.2)
    for k, side in ((31, -1), (35, 1)):
        wing = points[k] + [[side, 2], [6 * side, -4], [5 * side, -12]]
        canvas.stroke(wing, skin * 0.5, between(rng, 0.1, 0.9), rng.integers(1, 3), 1)
    if rng.random() < 0.5:
        side = rng.choice([-1, 1])
        bridge = points[27:31] + [side * between(rng, 5, 9), 0]
        canvas.stroke(bridge, skin * between(rng, 0.6, 0.9), between(rng, 0, 0.6), rng.integers(2, 9), 3)
