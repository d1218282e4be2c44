"""Glasses, and long lines on the face that no landmark knows."""

import cv2
import numpy as np

from toongeo.arrays import Floats, Mask, Singles
from toongeo.pipeline.parse.masks import filled, grown
from toongeo.pipeline.stylize.appearance.pixels import hull_of, placed_in
from toongeo.pipeline.stylize.appearance.subject import Subject
from toongeo.pipeline.stylize.strokes.canvas import Canvas
from toongeo.pipeline.stylize.strokes.curves import faired
from toongeo.pipeline.stylize.strokes.pens import Pens

__all__ = ["draw_rims", "long_lines"]

_RIM_WIDTH, _RIM_STRENGTH = 0.008, 0.9  # half of a rim's breadth, face sizes
_RIM_COLOUR, _LIGHTER = 80, 12.0  # of a light rim: percentile of what is seen along it, L* from the skin at least
_LONG = 0.30  # face sizes; wrinkles and lashes are shorter
_FEATURES = (  # landmarks and how far around them lines are those of features, face sizes
    (range(36, 42), 0.02),
    (range(42, 48), 0.02),
    (range(17, 22), 0.035),
    (range(22, 27), 0.035),
    (range(31, 36), 0.05),
    (range(48, 60), 0.05),
)


def draw_rims(canvas: Canvas, subject: Subject, pens: Pens) -> None:
    """Rims of glasses, over all else: dark ones by the pen, light ones in the picture's colour."""
    rims = subject.rims
    if rims is None:
        return
    places = np.rint(placed_in(np.concatenate(rims.lines), subject.factor)).astype(int)
    columns, rows = np.clip(places, 0, np.array(subject.seen.shape[1::-1]) - 1).T
    lab = np.percentile(subject.seen[rows, columns], _RIM_COLOUR, axis=0)
    light = rims.light and pens.tone[0] + _LIGHTER < 100  # on paper all is drawn dark
    paint = pens.colour(max(lab[0], pens.tone[0] + _LIGHTER), *(0.5 * lab[1:])) if light else pens.line
    for line in rims.lines:
        way = faired(line, 4)
        canvas.ribbon(way, np.full(len(way), _RIM_WIDTH * subject.size), paint, _RIM_STRENGTH)


def long_lines(response: Singles, subject: Subject, least: float) -> Singles:
    """The line response (h, w) of the reduced picture where a long line crosses the face, elsewhere 0."""
    points = placed_in(subject.landmarks, subject.factor)
    size = subject.size * subject.factor
    strong = (response > least) & (subject.skin.hull > 0.5) & ~_features(response.shape, points, size)
    count, parts, stats, _ = cv2.connectedComponentsWithStats(strong.astype(np.uint8), connectivity=8)
    extent = np.hypot(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT])
    kept = (extent > _LONG * size) & (np.arange(count) > 0)
    return np.where(grown(kept[parts], 2), response, 0).astype(np.float32)


def _features(shape: tuple[int, ...], points: Floats, size: float) -> Mask:
    mask = np.zeros(shape, bool)
    for part, margin in _FEATURES:
        mask |= grown(filled(shape, hull_of(points[list(part)])), margin * size)
    return mask
