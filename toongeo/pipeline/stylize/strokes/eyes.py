"""Eyes: white, iris, pupil, highlights, lids and crease."""

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Floats, Singles
from toongeo.pipeline.parse.masks import filled
from toongeo.pipeline.stylize.appearance.pixels import placed_in, rgb_of, soft_step
from toongeo.pipeline.stylize.appearance.subject import Subject
from toongeo.pipeline.stylize.strokes.canvas import Canvas
from toongeo.pipeline.stylize.strokes.curves import curve, faired, taper
from toongeo.pipeline.stylize.strokes.pens import Pens
from toongeo.pipeline.stylize.style import Style

__all__ = ["draw_eyes"]

_UPPER, _LOWER = ((36, 37, 38, 39), (42, 43, 44, 45)), ((36, 41, 40, 39), (42, 47, 46, 45))
_CLOSED = 0.12  # opening's height over its width below which only lids are drawn
_IRIS_COLOUR = 0.2  # eye widths around the middle of the iris whose colour is its colour
_IRIS_LIGHTNESS = (22.0, 48.0)
_UNKNOWN = (35.0, 5.0, 12.0)  # CIELAB, brown: of eyes whose iris does not show
_WIDEST = 0.40  # half the width of an iris, eye widths
_PUPIL, _RING = 0.44, 0.84  # radii, of the iris
# Highlights: places towards the light and down, radii and strength, of the iris.
_HIGHLIGHTS = ((0.34, -0.36, 0.26, 1.0), (-0.36, 0.42, 0.13, 0.75))
_WING = (0.10, 0.07)  # how far the upper lid's line goes on beyond the outer corner: out and up, eye widths


@dataclass(frozen=True, eq=False)
class _Eye:
    """An eye's opening: lids from left to right in the picture, and its frame."""

    upper: Floats
    lower: Floats
    corner: Floats
    across: Floats
    down: Floats
    width: float
    height: float
    outer_first: bool  # whether the outer corner comes first


def draw_eyes(canvas: Canvas, subject: Subject, style: Style, pens: Pens) -> None:
    """Both eyes with one colour of iris."""
    eyes = [_eye(subject.landmarks, side) for side in (0, 1)]
    iris = _iris_colour(subject, eyes)
    for eye, centre in zip(eyes, subject.irises, strict=True):
        if eye.height > _CLOSED * eye.width:
            _draw_ball(canvas, eye, centre, iris, style, pens)
        _draw_lids(canvas, eye, style, pens)


def _eye(landmarks: Floats, side: int) -> _Eye:
    upper, lower = curve(landmarks[list(_UPPER[side])]), curve(landmarks[list(_LOWER[side])])
    width = float(np.linalg.norm(upper[-1] - upper[0]))
    across = (upper[-1] - upper[0]) / max(width, 1e-9)
    down = np.array([-across[1], across[0]])
    height = max(float(((lower - upper) @ down).max()), 0.0)
    return _Eye(upper, lower, upper[0], across, down, width, height, side == 0)


def _middle(eye: _Eye, found: Floats | None) -> Floats:
    if found is not None:
        return found
    return np.asarray((eye.upper[len(eye.upper) // 2] + eye.lower[len(eye.lower) // 2]) / 2)


def _iris_colour(subject: Subject, eyes: list[_Eye]) -> Singles:
    """CIELAB (3,) of both irises, by what the reduced picture shows of them."""
    seen = []
    for eye, found in zip(eyes, subject.irises, strict=True):
        opening = filled(subject.seen.shape, placed_in(np.vstack([eye.upper, eye.lower[::-1]]), subject.factor))
        rows, columns = np.nonzero(opening)
        x, y = placed_in(_middle(eye, found), subject.factor)
        near = (columns - x) ** 2 + (rows - y) ** 2 < (_IRIS_COLOUR * eye.width * subject.factor) ** 2
        seen.append(subject.seen[rows[near], columns[near]])
    colours = np.concatenate(seen)
    return np.asarray(np.percentile(colours, 55, axis=0) if len(colours) else _UNKNOWN, np.float32)


def _draw_ball(canvas: Canvas, eye: _Eye, found: Floats | None, iris: Singles, style: Style, pens: Pens) -> None:
    """White with the lid's shadow, and an iris that hangs from the upper lid."""
    box, opening = canvas.shape_of(np.vstack([eye.upper, eye.lower[::-1]]))
    rows, columns = np.mgrid[box].astype(np.float32)
    at = np.stack([columns, rows], axis=-1) - eye.corner.astype(np.float32)
    x, y = at @ eye.across.astype(np.float32), at @ eye.down.astype(np.float32)
    lid = np.interp(x, (eye.upper - eye.corner) @ eye.across, (eye.upper - eye.corner) @ eye.down)
    below = np.asarray(y - lid, np.float32)
    shadow = soft_step(np.float32(0.16 * eye.height) - below, 0.05 * eye.height)[..., None]
    white, shaded = pens.colour(95, 0.5, 2), pens.colour(76, 1, -3)
    ball = white + shadow * (shaded - white)
    centre, radius = _iris_place(eye, _middle(eye, found) - eye.corner, style)
    tall = radius * (1.12 if style.big_eyes else 1.0)
    u, v = (x - np.float32(centre[0])) / np.float32(radius), (y - np.float32(centre[1])) / np.float32(tall)
    distance = np.hypot(u, v)
    edge = 1.2 / radius  # a pixel and a bit
    ball = ball + soft_step(1 - distance, edge)[..., None] * (_iris(u, v, distance, below, eye, iris, pens) - ball)
    canvas_part = canvas.rgb[box]
    canvas_part += np.float32(style.eyes) * opening[..., None] * (ball - canvas_part)


def _iris_place(eye: _Eye, middle: Floats, style: Style) -> tuple[tuple[float, float], float]:
    """Centre in the eye's frame and radius, px: it never shows white above."""
    radius = max(0.5 * style.iris * eye.width, (0.52 if style.big_eyes else 0.48) * eye.height)
    radius = min(radius, _WIDEST * eye.width)
    x, y = float(middle @ eye.across), float(middle @ eye.down)
    heights = [
        np.interp(x, (lid - eye.corner) @ eye.across, (lid - eye.corner) @ eye.down) for lid in (eye.upper, eye.lower)
    ]
    top, bottom = heights[0] + 0.55 * radius, max(heights[0] + 0.80 * radius, heights[1] - 0.8 * radius)
    return (x, float(np.clip(y, top, bottom))), radius


def _iris(u: Singles, v: Singles, distance: Singles, below: Singles, eye: _Eye, iris: Singles, pens: Pens) -> Singles:
    """RGB of an iris: darker under the lid and at its ring, with a pupil and highlights."""
    lightness = np.clip(iris[0], *_IRIS_LIGHTNESS) + 16 * np.clip(v, -1, 1)
    lightness = lightness - 22 * soft_step(distance - _RING, 0.05)
    lightness = lightness - 14 * soft_step(np.float32(0.3 * eye.height) - below, 0.06 * eye.height)
    even = np.ones_like(lightness)
    hue = 1.6 * pens.hue
    rgb = rgb_of(np.stack([lightness, hue * iris[1] * even, hue * iris[2] * even], axis=-1).astype(np.float32))
    edge = 0.04
    rgb += soft_step(_PUPIL - distance, edge)[..., None] * (pens.colour(6) - rgb)
    for towards, down, radius, strength in _HIGHLIGHTS:
        spot = soft_step(radius - np.hypot(u - pens.light_side * towards, v - down), edge)
        rgb += np.float32(strength) * spot[..., None] * (255 - rgb)
    return np.asarray(rgb)


def _draw_lids(canvas: Canvas, eye: _Eye, style: Style, pens: Pens) -> None:
    """The upper lid's line with a wing at the outer corner, the lower lid's, and the crease."""
    end = 0 if eye.outer_first else -1
    outwards = -eye.across if eye.outer_first else eye.across
    tip = eye.upper[end] + (outwards * _WING[0] - eye.down * _WING[1]) * eye.width
    wing = np.linspace(tip, eye.upper[end], 9)[:-1]
    line = faired(np.vstack([wing, eye.upper]) if eye.outer_first else np.vstack([eye.upper, wing[::-1]]), 4)
    width = (0.8 if style.line < 0.008 else 1.05) * pens.width
    dark = pens.colour(10, 2, 2)
    canvas.ribbon(line, width * _along(line, eye, (0, 0.14, 0.45, 0.8, 1), (0.05, 1.25, 1.15, 0.8, 0.25)), dark, 0.97)
    lower = eye.lower
    canvas.ribbon(lower, 0.32 * pens.width * _along(lower, eye, (0, 0.1, 0.5, 1), (1.4, 1.2, 0.7, 0.2)), pens.line, 0.7)
    if style.crease > 0:
        lift = (0.17 if style.big_eyes else 0.13) * eye.width
        shape = lift * np.interp(np.linspace(0, 1, len(eye.upper)), [0, 0.5, 1], [0.75, 1, 0.75])
        crease = (eye.upper - eye.down * shape[:, None])[3:-3]
        canvas.ribbon(crease, 0.34 * pens.width * taper(len(crease), 0.35, 0.35), pens.line, style.crease)


def _along(line: Floats, eye: _Eye, places: tuple[float, ...], widths: tuple[float, ...]) -> Floats:
    """Widths along a lid, from its outer to its inner end."""
    t = np.linspace(0, 1, len(line))
    return np.asarray(np.interp(t if eye.outer_first else 1 - t, places, widths))
