"""Drawings in black ink."""

import numpy as np

from toongeo.arrays import Singles
from toongeo.pipeline.stylize.appearance.pixels import antialiased, enlarged, soft_step
from toongeo.pipeline.stylize.appearance.subject import Subject
from toongeo.pipeline.stylize.coloured_drawing import visible_skin
from toongeo.pipeline.stylize.face_frame import face_frame
from toongeo.pipeline.stylize.strokes.canvas import Canvas
from toongeo.pipeline.stylize.strokes.eyes import draw_eyes
from toongeo.pipeline.stylize.strokes.mouth import draw_mouth
from toongeo.pipeline.stylize.strokes.outline import draw_brows, draw_jaw, draw_nose, skin_outline
from toongeo.pipeline.stylize.strokes.pens import pens_of
from toongeo.pipeline.stylize.strokes.spectacles import draw_rims
from toongeo.pipeline.stylize.style import Style

__all__ = ["ink_drawing"]

_PAPER = 252.0
_MASS, _DARKEST_MASS = 0.45, 34.0  # lightness below which all is black: of the skin's, and at most
_LEAST_LINE, _LEAST_WHITE = 1.8, 1.6  # L* of the line response
_PITCH = 0.036  # of the hatching, face sizes
_HATCH_DIRECTION = (0.8, 0.6)  # across the lines, away from the light and down
_HATCH_FROM, _HATCH_GROWTH, _HATCH_WIDEST = 0.55, 0.55, 0.55  # of the shade; widths are parts of the pitch
_SHADE, _PHOTO, _PHOTO_SPREAD = 0.7, 0.45, 20.0


def ink_drawing(subject: Subject, style: Style) -> Singles:
    """RGB (h, w, 3) in 0..255: masses of black, lines along edges, and hatching where the fitted light is weak."""
    lightness = enlarged(np.ascontiguousarray(subject.small[..., 0]), subject.shape)
    skin, hull, response = subject.skin_cover, subject.hull, subject.response
    pens = pens_of(subject, style)
    darkest = np.float32(min(_MASS * float(subject.skin.median[0]), _DARKEST_MASS))
    mass = antialiased(darkest - lightness, 0.25) * (1 - hull * soft_step(skin - 0.4, 0.1))
    white = 0.9 * antialiased(-response - _LEAST_WHITE, 0.12) * mass
    on_face = hull * (skin > 0.3) * (1 - subject.unexplained)
    lines = antialiased(response - _LEAST_LINE, 0.12) * (1 - 0.9 * on_face)
    border = skin_outline(subject, 0.42 * pens.width)
    black = np.maximum(np.maximum(mass - white, lines), np.maximum(border, _hatching(subject, lightness, skin)))
    canvas = Canvas(np.full((*lightness.shape, 3), _PAPER, np.float32))
    canvas.cover(np.asarray(black, np.float32), pens.line)
    draw_mouth(canvas, subject, style, pens)
    draw_nose(canvas, subject, style, pens)
    draw_jaw(canvas, subject, pens, visible_skin(subject))
    draw_brows(canvas, subject, style, pens)
    draw_eyes(canvas, subject, style, pens)
    draw_rims(canvas, subject, pens)
    return canvas.rgb


def _hatching(subject: Subject, lightness: Singles, skin: Singles) -> Singles:
    """Cover (h, w) of parallel lines that widen with shade."""
    shade = enlarged(subject.light.shade, lightness.shape)
    photo = np.clip((lightness - subject.skin.median[0]) / _PHOTO_SPREAD, -1.5, 1.2)
    mix = _SHADE * shade + _PHOTO * photo
    frame = face_frame(subject.landmarks)
    rows, columns = np.mgrid[: lightness.shape[0], : lightness.shape[1]].astype(np.float32)
    across, down = (frame.axes / frame.size).astype(np.float32)
    x, y = columns - np.float32(frame.origin[0]), rows - np.float32(frame.origin[1])
    side = -1.0 if subject.light.from_right else 1.0
    direction = side * _HATCH_DIRECTION[0] * across + _HATCH_DIRECTION[1] * down
    phase = (x * direction[0] + y * direction[1]) / np.float32(_PITCH)
    away = 2 * np.abs(phase - np.rint(phase))  # 0 on the middle of a line
    width = np.clip(_HATCH_GROWTH * (-mix - _HATCH_FROM), 0, _HATCH_WIDEST) * skin
    return antialiased(np.asarray(width - away, np.float32), 0.03) * (width > 0.03)
