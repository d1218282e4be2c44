"""Lips, teeth and the line between the lips."""

import numpy as np

from toongeo.arrays import Floats
from toongeo.pipeline.stylize.appearance.subject import Subject
from toongeo.pipeline.stylize.strokes.canvas import Canvas
from toongeo.pipeline.stylize.strokes.curves import curve, taper, unit
from toongeo.pipeline.stylize.strokes.pens import Pens
from toongeo.pipeline.stylize.style import Style

__all__ = ["draw_mouth"]

_OPEN = 0.025  # face sizes between the lips
_DARKER = (10.0, 26.0)  # L* below the skin, least and most: redder than it, but no shadow
_EDGE = 0.004  # face sizes, sigma of the edges of lips
# What shows between the lips: dark below this share of the skin's lightness, teeth if it has less of the skin's colour
# than this share (or, in grey pictures, is lighter than the skin), else the lips are closed, whatever the points say.
_DARK, _PALE = 0.6, 0.75
_BAND = 0.88  # of the opening's height that teeth fill, as one band


def draw_mouth(canvas: Canvas, subject: Subject, style: Style, pens: Pens) -> None:
    """Paint the lips, and between them teeth or darkness."""
    points, size = subject.landmarks, subject.size
    mouth = np.vstack([curve(points[60:65]), curve(points[[64, 65, 66, 67, 60]])])
    gap = float(np.linalg.norm(points[61:64] - points[[67, 66, 65]], axis=1).mean()) / size
    teeth, dark = _between(canvas, subject, mouth)
    opened = gap > _OPEN and (teeth or dark)
    if style.lips > 0:
        _lips(canvas, subject, style, pens)
    if opened:
        _opening(canvas, subject, pens, mouth, teeth)
    middle = points[61:64] if opened else (points[61:64] + points[[67, 66, 65]]) / 2
    line = curve(np.vstack([points[48], middle, points[54]]))
    canvas.ribbon(line, 0.6 * pens.width * taper(len(line), 0.25, 0.25), pens.line, 0.95)
    if opened:
        line = curve(points[[48, 67, 66, 65, 54]])
        canvas.ribbon(line, 0.35 * pens.width * taper(len(line), 0.3, 0.3), pens.line, 0.8)
    under = curve(points[[58, 57, 56]] + 0.035 * size * unit(points[8] - points[57]))
    shadow = pens.colour(pens.tone[0] - 22, 1.2 * pens.tone[1], pens.tone[2])
    canvas.ribbon(under, 0.45 * pens.width * taper(len(under), 0.5, 0.5), shadow, 0.7)


def _lips(canvas: Canvas, subject: Subject, style: Style, pens: Pens) -> None:
    points = subject.landmarks
    upper = np.vstack([curve(points[48:55]), curve(points[[54, 64, 63, 62, 61, 60, 48]])])
    lower = np.vstack([curve(points[[54, 55, 56, 57, 58, 59, 48]]), curve(points[[48, 60, 67, 66, 65, 64, 54]])])
    drawn = []
    for outline in (upper, lower):
        box, cover = canvas.shape_of(outline)
        inside = cover > 0.5
        drawn.append(subject.lab[box][inside])
    seen = np.concatenate(drawn)
    middle = np.median(seen, axis=0) if len(seen) else subject.skin.median
    lightness = np.clip(middle[0], pens.tone[0] - _DARKER[1], pens.tone[0] - _DARKER[0])
    red, yellow = middle[1] * style.chroma + 6, middle[2] * style.chroma
    edge = _EDGE * subject.size
    canvas.polygon(upper, pens.colour(lightness - 6, red, yellow), style.lips, edge)
    canvas.polygon(lower, pens.colour(lightness, red, yellow), style.lips, edge)


def _between(canvas: Canvas, subject: Subject, mouth: Floats) -> tuple[bool, bool]:
    """Whether teeth, and whether the dark of the mouth show between the lips."""
    box, cover = canvas.shape_of(mouth)
    inside = subject.lab[box][cover > 0.5]
    if not len(inside):
        return False, False
    skin = subject.skin.median
    bright = inside[inside[:, 0] >= np.percentile(inside[:, 0], 60)].mean(axis=0)
    pale = bright[0] > skin[0] if subject.grey else np.hypot(*bright[1:]) < _PALE * np.hypot(*skin[1:])
    return bool(pale and bright[0] > _DARK * skin[0]), bool(np.percentile(inside[:, 0], 25) < _DARK * skin[0])


def _opening(canvas: Canvas, subject: Subject, pens: Pens, mouth: Floats, teeth: bool) -> None:
    canvas.polygon(mouth, pens.colour(22, 18, 8))
    if teeth:
        upper, lower = curve(subject.landmarks[60:65]), curve(subject.landmarks[[60, 67, 66, 65, 64]])
        canvas.polygon(np.vstack([upper, ((1 - _BAND) * upper + _BAND * lower)[::-1]]), pens.colour(94, 0, 3))
