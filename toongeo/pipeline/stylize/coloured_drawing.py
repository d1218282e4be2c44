"""Drawings in colour: toon, chibi, caricature, painted."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.stylize.appearance.brush_marks import brush_marks
from toongeo.pipeline.stylize.appearance.palette import in_palette, palette_of
from toongeo.pipeline.stylize.appearance.pixels import antialiased, blurred, enlarged, rgb_of, soft_step
from toongeo.pipeline.stylize.appearance.skin_tones import toned_skin
from toongeo.pipeline.stylize.appearance.subject import Subject
from toongeo.pipeline.stylize.strokes.canvas import Canvas
from toongeo.pipeline.stylize.strokes.eyes import draw_eyes
from toongeo.pipeline.stylize.strokes.mouth import draw_mouth
from toongeo.pipeline.stylize.strokes.outline import draw_brows, draw_jaw, draw_nose, skin_outline
from toongeo.pipeline.stylize.strokes.pens import Pens, pens_of
from toongeo.pipeline.stylize.strokes.spectacles import draw_rims, long_lines
from toongeo.pipeline.stylize.style import Style

__all__ = ["Backdrop", "coloured_drawing", "surroundings", "visible_skin"]

_SKIN_WEIGHT = 0.8  # by which skin counts less for the palette of all else
_HAIR_COLOURS, _HAIRY = 0.4, 0.2  # of the palette's colours; where there is so much hair, in areas of skin
_ELSEWHERE = 900.0  # squared Lab, against colours of hair outside it and others in it
_SOFT_CUT = 0.12  # of the skin's border
_OWN_LIGHTNESS = 0.65  # of the lightness outside the skin that comes in levels; the rest is the palette's
_LEVEL_SLOPE, _SOFT_LEVEL_SLOPE = 3.5, 1.2  # of the steps between levels; the second without a palette
_LEAST_LINE, _LEAST_LONG_LINE = 2.3, 1.5  # L* of the line response; less is noise
_LINE_EDGE = 0.15  # of the response a pixel
_ON_FACE = 0.92  # of the lines that are left out on the face: its own are drawn by its landmarks
# Blush: a Gaussian between eye and corner of the mouth (face sizes), in L*, a*, b*.
_CHEEKS = ((36, 48, 48, 31), (45, 54, 54, 35))
_BLUSH_RADIUS, _BLUSH = 0.11, (-4.0, 22.0, 5.0)


@dataclass(frozen=True, eq=False)
class Backdrop:
    """All but the skin, which the drawing and its variant for textures share.

    Attributes
    ----------
    lab, rgb : (h, w, 3) float32
        The same in CIELAB, and in 0..255.
    lines : (h, w) float32
        Cover of lines along edges.
    long_dark, long_light : (h, w) float32 or None
        Covers of long lines on the face, where there are any.
    """

    lab: Singles
    rgb: Singles
    lines: Singles
    long_dark: Singles | None
    long_light: Singles | None


def coloured_drawing(subject: Subject, style: Style, backdrop: Backdrop) -> Singles:
    """RGB (h, w, 3) in 0..255; ``backdrop`` is what :func:`surroundings` gives for the style."""
    box, skin = subject.skin_box, subject.skin_cover
    lab = backdrop.lab[box].copy()
    cover = soft_step(skin[box] - 0.5, _SOFT_CUT) if style.palette else skin[box]
    lab += cover[..., None] * (toned_skin(subject, style) - lab)
    if style.blush > 0 and not subject.grey:
        _add_blush(lab, subject, cover, style.blush)
    rgb = backdrop.rgb.copy()
    rgb[box] = rgb_of(lab)
    pens = pens_of(subject, style)
    canvas = Canvas(rgb)
    if style.outlines > 0:
        _draw_outlines(canvas, subject, backdrop.lines, style, pens)
    draw_mouth(canvas, subject, style, pens)
    draw_nose(canvas, subject, style, pens)
    draw_jaw(canvas, subject, pens, visible_skin(subject))
    draw_brows(canvas, subject, style, pens)
    draw_eyes(canvas, subject, style, pens)
    if backdrop.long_dark is not None:
        canvas.cover(backdrop.long_dark, pens.line, 0.85)
    if backdrop.long_light is not None:
        canvas.cover(backdrop.long_light, rgb_of(subject.lab), 0.85)
    draw_rims(canvas, subject, pens)
    if style.brush > 0:
        canvas.rgb *= brush_marks(subject, style.brush)
    return canvas.rgb


def visible_skin(subject: Subject) -> Singles:
    """Cover (h, w) of what shows skin, a little beyond its border."""
    size = subject.size * subject.factor
    near = blurred(subject.skin.seen, 0.015 * size)
    return np.clip(6 * subject.full(near) - 0.5, 0, 1)


def surroundings(subject: Subject, style: Style) -> Backdrop:
    """All but the skin: few colours, lightness in levels (Winnemoeller et al. 2006), and lines."""
    if style.palette == 0:
        lab = subject.lab.copy()
        lab[..., 0] = _levelled(subject.lab[..., 0], style.levels, _SOFT_LEVEL_SLOPE)
    else:
        lab = _in_few_colours(subject, style.palette)
        levels = _levelled(subject.lab[..., 0], style.levels, _LEVEL_SLOPE)
        lab[..., 0] += np.float32(_OWN_LIGHTNESS) * (levels - lab[..., 0])
    lab[..., 1:] *= np.float32(style.chroma)
    on_face = subject.hull * (subject.skin_cover > 0.3) * (1 - subject.unexplained)
    lines = antialiased(subject.response - _LEAST_LINE, _LINE_EDGE) * (1 - _ON_FACE * on_face)
    on_it = (
        (None, None) if subject.rims else (_long_lines(subject, subject.lines), _long_lines(subject, -subject.lines))
    )
    return Backdrop(lab, rgb_of(lab), np.asarray(lines, np.float32), *on_it)


def _in_few_colours(subject: Subject, count: int) -> Singles:
    """The drawing (h, w, 3) in the colours of a palette; hair has colours of its own."""
    hair, other = subject.hair, 1 - np.maximum(subject.hair, _SKIN_WEIGHT * subject.skin.drawn)
    smooth = np.asarray(cv2.medianBlur(subject.small, 5), np.float32)  # no specks: 5 px are 0.05 face sizes
    hairy = round(_HAIR_COLOURS * count) if hair.mean() > _HAIRY * subject.skin.drawn.mean() else 0
    palette = palette_of(smooth, other, count - hairy)
    barred = np.full(len(palette), _ELSEWHERE if hairy else 0.0)
    if hairy:
        own = palette_of(smooth, hair, hairy)
        palette, barred = np.concatenate([palette, own]), np.append(barred, np.full(len(own), -_ELSEWHERE))
    fields = blurred(np.dstack([smooth, hair]), 0.006 * subject.size * subject.factor)
    return in_palette(enlarged(fields, subject.shape), palette, barred.astype(np.float32))


def _levelled(lightness: Singles, count: int, slope: float) -> Singles:
    """Soft steps between levels of lightness."""
    width = np.float32(100 / count)
    place = lightness / width
    level = np.floor(place)
    step = np.tanh(2 * slope * (place - level - 0.5)) / np.float32(np.tanh(slope))
    return np.asarray(width * (level + 0.5 + 0.5 * step), np.float32)


def _add_blush(lab: Singles, subject: Subject, cover: Singles, strength: float) -> None:
    """Into the skin's box of a drawing, CIELAB."""
    radius, start = _BLUSH_RADIUS * subject.size, [part.start for part in subject.skin_box[::-1]]
    for a, b, c, d in _CHEEKS:
        middle = 0.8 * subject.landmarks[[a, b]].mean(axis=0) + 0.2 * subject.landmarks[[c, d]][1] - start
        low = np.maximum(np.floor(middle - 4 * radius).astype(int), 0)
        high = np.maximum(np.ceil(middle + 4 * radius).astype(int), 0)
        box = np.s_[low[1] : high[1], low[0] : high[0]]
        part = lab[box]
        if part.size:
            rows, columns = np.mgrid[low[1] : low[1] + part.shape[0], low[0] : low[0] + part.shape[1]]
            square = (columns - middle[0]) ** 2 + (rows - middle[1]) ** 2
            blob = np.exp(-square / (2 * radius**2)).astype(np.float32) * cover[box]
            part += np.float32(strength) * blob[..., None] * np.array(_BLUSH, np.float32)


def _draw_outlines(canvas: Canvas, subject: Subject, lines: Singles, style: Style, pens: Pens) -> None:
    """Lines outside the face where the picture has them, and the outline of the skin."""
    canvas.cover(lines, pens.line, 0.85 * style.outlines)
    canvas.cover(skin_outline(subject, 0.30 * pens.width), pens.line, 0.8)


def _long_lines(subject: Subject, response: Singles) -> Singles | None:
    """Cover (h, w) of straps, scars and the like, by a line response of the reduced picture."""
    response = long_lines(response, subject, _LEAST_LONG_LINE)
    if not response.any():
        return None
    return antialiased(enlarged(response, subject.shape) - _LEAST_LONG_LINE, _LINE_EDGE)
