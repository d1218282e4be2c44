"""Nose, jaw and brows."""

import numpy as np

from toongeo.arrays import Floats, Singles
from toongeo.pipeline.stylize.appearance.pixels import blurred
from toongeo.pipeline.stylize.appearance.steep_edges import border_line
from toongeo.pipeline.stylize.appearance.subject import Subject
from toongeo.pipeline.stylize.strokes.canvas import Canvas
from toongeo.pipeline.stylize.strokes.curves import curve, faired, taper, unit
from toongeo.pipeline.stylize.strokes.pens import Pens
from toongeo.pipeline.stylize.style import Style

__all__ = ["draw_brows", "draw_jaw", "draw_nose", "skin_outline"]

_BROWS = (range(17, 22), range(26, 21, -1))  # from the outer end
# Half the height of a brow along it, of the face's size, and the sigma of its edge.
_BROW_HEIGHT, _BROW_SHAPE = 0.030, ((0.0, 0.35, 0.82, 0.95, 1.0), (0.12, 0.75, 1.0, 0.8, 0.35))
_BROW_DOWN = 0.012  # the landmarks are on the upper edge
_BROW_EDGE = 0.004
_BROW_DARKER = 25.0  # L*, than the skin, at least
_JAW_FADE = 0.30  # of its length, at both ends


def draw_nose(canvas: Canvas, subject: Subject, style: Style, pens: Pens) -> None:
    """Wings, base and nostrils; in flat small noses the base alone."""
    points, size = subject.landmarks, subject.size
    down = unit(points[33] - points[27])
    softness = 0.3 + 0.0015 * size
    width = 0.42 * pens.width
    lines = []
    base = curve(points[[32, 33, 34]])
    lines.append((base, width * taper(len(base), 0.4, 0.4)))
    if style.crease > 0 or not style.big_eyes or style.tones == 1:
        for wing in (31, 35):
            out, inwards = points[wing] - points[33], points[33] - points[wing]
            line = curve(
                np.vstack(
                    [
                        points[wing] - 0.05 * size * down,
                        points[wing] + 0.12 * out,
                        points[wing] + 0.012 * size * down + 0.15 * inwards,
                    ]
                )
            )
            lines.append((line, width * taper(len(line), 0.6, 0.3)))
        for near, far in ((32, 31), (34, 35)):
            line = curve(
                np.vstack([0.8 * points[near] + 0.2 * points[far], 0.45 * points[near] + 0.55 * points[far]]), 8
            )
            lines.append((line, 1.8 * width * taper(len(line), 0.4, 0.4)))
    for line, half in lines:
        canvas.ribbon(line, half, pens.line, style.nose, softness)


def draw_jaw(canvas: Canvas, subject: Subject, pens: Pens, skin: Singles) -> None:
    """The line of the jaw, where skin shows (h, w)."""
    line = faired(curve(subject.landmarks[1:16], 10), 9)
    t = np.linspace(0, 1, len(line))
    ends = np.clip(np.minimum(t, 1 - t) / _JAW_FADE, 0, 1) ** 1.1
    canvas.ribbon(line, 0.62 * pens.width * ends * (0.85 + 0.35 * np.abs(2 * t - 1)), pens.line, 0.85, within=skin)


def skin_outline(subject: Subject, half_width: float) -> Singles:
    """Cover (h, w) of a line around the skin, but for the face, whose jaw is drawn by its landmarks; px."""
    size = subject.size * subject.factor
    face = subject.full(np.asarray(np.clip(1.6 * blurred(subject.skin.hull, 0.02 * size), 0, 1)))
    return np.asarray(border_line(blurred(subject.skin_cover, 0.008 * subject.size), half_width) * (1 - face))


def draw_brows(canvas: Canvas, subject: Subject, style: Style, pens: Pens) -> None:
    """Brows as filled ribbons of their own dark colour, one for both."""
    down = unit(subject.landmarks[33] - subject.landmarks[27])
    lines = [faired(curve(subject.landmarks[list(brow)], 10), 5) for brow in _BROWS]
    if style.ink:
        paint, strength, softness, height = pens.line, 1.0, 0.0, 0.87 * _BROW_HEIGHT
    else:
        dark = np.minimum(*(_dark_colour(subject, line) for line in lines))
        lightness = max(min(max(0.7 * dark[0], 10.0), pens.tone[0] - _BROW_DARKER), 4.0)
        paint = pens.colour(lightness, dark[1], 0.8 * dark[2])
        strength, softness, height = style.brows, _BROW_EDGE * subject.size, _BROW_HEIGHT
    for line in lines:
        half = height * subject.size * np.interp(np.linspace(0, 1, len(line)), *_BROW_SHAPE)
        canvas.ribbon(line + _BROW_DOWN * subject.size * down, half, paint, strength, softness)


def _dark_colour(subject: Subject, line: Floats) -> Singles:
    """The dark of the picture around a brow."""
    low = np.maximum(line.min(axis=0).astype(int), 0)
    high = line.max(axis=0).astype(int) + [1, 1 + int(0.05 * subject.size)]
    around = subject.lab[low[1] : max(high[1], low[1] + 1), low[0] : max(high[0], low[0] + 1)].reshape(-1, 3)
    return np.asarray(np.percentile(around, 8, axis=0) if len(around) else subject.skin.median, np.float32)
