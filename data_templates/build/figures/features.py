"""Nose, mouth and brows of a drawn face."""

from __future__ import annotations

import numpy as np
from renders.canvas import Canvas, between
from renders.palette import Palette

from figures.layout import Layout
from figures.outline import Line, smooth_curve

__all__ = ["paint_brows", "paint_mouth", "paint_nose"]

_NOSES = ("stroke", "angle", "curve", "dots", "triangle", "bulb", "bridge", "shade")
_PALE, _DARK = np.array([250.0, 248.0, 240.0]), np.array([60.0, 15.0, 20.0])


def paint_nose(rng, canvas: Canvas, layout: Layout, palette: Palette, line: Line) -> None:
    """One of eight noses."""
    points, kind = layout.points, str(rng.choice(_NOSES))
    side = np.sign(layout.yaw) if abs(layout.yaw) > 12 else rng.choice([-1, 1])
    wing, base = points[31 if side > 0 else 35], points[33]
    shade = palette.skin * between(rng, 0.45, 0.85)
    pen = line if line.width and rng.random() < 0.7 else Line(shade, between(rng, 1, 3))
    far = points[35 if side > 0 else 31]
    if kind == "stroke":
        pen.draw(canvas, layout.placed([wing * 0.6 + base * 0.4, base, far * 0.6 + base * 0.4]), 1.3)
    elif kind == "angle":
        start = points[rng.choice([27, 28, 29])]
        pen.draw(canvas, layout.placed([start, points[30] * 0.6 + far * 0.4, base]))
    elif kind == "curve":
        pen.draw(canvas, layout.placed(smooth_curve(points[31:36])))
    elif kind == "dots":
        size = np.linalg.norm(layout.axes[0]) * between(rng, 0.02, 0.05)
        for k in (32, 34):
            canvas.ellipse(layout.placed(points[k : k + 1])[0], (size, 0.7 * size), pen.colour, 1, 0.4)
    elif kind == "triangle":
        ring = layout.placed([points[rng.choice([27, 28, 29])], points[31], points[35]])
        canvas.fill(ring, shade if rng.random() < 0.6 else palette.skin)
        if rng.random() < 0.6:
            pen.draw(canvas, ring, closed=True)
    elif kind == "bulb":
        half = np.linalg.norm(points[35] - points[31]) / 2 * 1.1
        angle = np.linspace(0, 2 * np.pi, 20, endpoint=False)
        tall = max(base[1] - points[30, 1], 0.6 * half)
        middle = (points[30] + base) / 2
        ring = layout.placed(middle + np.column_stack([half * np.cos(angle), tall * np.sin(angle)]))
        canvas.fill(ring, palette.skin * [1, between(rng, 0.7, 1), between(rng, 0.7, 1)])
        pen.draw(canvas, ring[3:] if rng.random() < 0.4 else ring, closed=False)
    elif kind == "bridge":
        for root, tip in ((points[21], points[31]), (points[22], points[35])):
            if rng.random() < 0.7:
                pen.draw(canvas, layout.placed(smooth_curve([root, points[28] + (tip - base) * 0.4, tip])), 0.8)
        pen.draw(canvas, layout.placed(smooth_curve(points[31:36])))
    else:
        canvas.fill(layout.placed([points[28], points[30], base, wing]), shade, 1, between(rng, 0.3, 3))
    if kind in ("angle", "curve", "bulb", "bridge", "shade") and rng.random() < 0.3:
        size = np.linalg.norm(layout.axes[0]) * between(rng, 0.015, 0.04)
        for k in (32, 34):
            canvas.ellipse(layout.placed(points[k : k + 1])[0], (size, 0.7 * size), shade * 0.5, 1, 0.4)


def paint_mouth(rng, canvas: Canvas, layout: Layout, palette: Palette, line: Line) -> None:
    """Lips, or a line, or an open mouth with teeth and a tongue."""
    points = layout.points
    pen = line if line.width else Line(palette.lips * 0.4, between(rng, 1, 3))
    outer = layout.placed(np.vstack([smooth_curve(points[48:55]), smooth_curve(points[[54, *range(55, 60), 48]])]))
    within = layout.placed(np.vstack([smooth_curve(points[60:65]), smooth_curve(points[[64, 65, 66, 67, 60]])]))
    full = np.linalg.norm(points[57] - points[66]) > 0.09 * np.linalg.norm(points[54] - points[48])
    if full:
        canvas.fill(outer, palette.lips * between(rng, 0.8, 1.1), 1, 0.4)
        if rng.random() < 0.5:
            pen.draw(canvas, outer, between(rng, 0.4, 1), closed=True)
    if layout.open:
        teeth = rng.random()
        canvas.fill(within, _PALE if teeth < 0.3 else _DARK * between(rng, 0, 2), 1, 0.4)
        if teeth < 0.3 and rng.random() < 0.5:
            pen.draw(canvas, layout.placed((points[61:64] + points[[67, 66, 65]]) / 2), 0.5)
        elif 0.3 < teeth < 0.6:
            drop = (points[[67, 66, 65]] - points[61:64]) * between(rng, 0.2, 0.5)
            canvas.fill(layout.placed(np.vstack([points[60:65], (points[61:64] + drop)[::-1]])), _PALE, 1, 0.4)
        elif teeth > 0.8:
            low = points[65:68] + (points[[63, 62, 61]] - points[65:68]) * between(rng, 0.2, 0.5)
            canvas.fill(layout.placed(np.vstack([points[65:68], low[::-1]])), [205, 90, 90], 1, 0.6)
        pen.draw(canvas, within, 0.8, closed=True)
    else:
        pen.draw(
            canvas,
            layout.placed(smooth_curve(points[60:65] if full else points[[48, 61, 62, 63, 54]])),
            between(rng, 0.7, 1.4),
        )
    if not full and rng.random() < 0.3:  # a short line below the lip
        below = points[[58, 57, 56]] + [0, between(rng, 0.03, 0.12)]
        pen.draw(canvas, layout.placed(below), 0.8)


def paint_brows(rng, canvas: Canvas, layout: Layout, palette: Palette, line: Line) -> None:
    """Strokes, bars, or shapes that taper; the landmarks lie on the upper half of them."""
    if rng.random() < 0.05:
        return
    thick, taper, outlined = between(rng, 0.02, 0.17), rng.random() < 0.6, rng.random() < 0.35
    colour = line.colour if rng.random() < 0.35 else palette.brows
    for side, rows in ((-1, slice(17, 22)), (1, slice(22, 27))):
        curve = smooth_curve(layout.points[rows])
        profile = np.linspace(0.25, 1, len(curve))[::-side] if taper else np.ones(len(curve))
        top = curve - np.outer(profile * thick, [0, 0.3])
        ring = layout.placed(np.vstack([top, (top + np.outer(profile * thick, [0, 1]))[::-1]]))
        canvas.fill(ring, colour, 1, 0.3)
        if outlined:
            line.draw(canvas, ring, 0.7, closed=True)
