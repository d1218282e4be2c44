"""Long dark lines on the face that no landmark knows: rims of glasses above all."""

import cv2
import numpy as np

from toongeo.arrays import Floats, Mask, Singles
from toongeo.pipeline.parse.masks import filled, grown
from toongeo.pipeline.stylize.appearance.pixels import hull_of, placed_in
from toongeo.pipeline.stylize.appearance.subject import Subject

__all__ = ["long_lines"]

_LONG = 0.30  # face sizes; wrinkles and lashes are shorter
_FEATURES = (  # landmarks and how far around them lines are those of features, face sizes
    (range(36, 42), 0.02),
    (range(42, 48), 0.02),
    (range(17, 22), 0.035),
    (range(22, 27), 0.035),
    (range(31, 36), 0.05),
    (range(48, 60), 0.05),
)


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
