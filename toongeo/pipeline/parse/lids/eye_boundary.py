"""The outline of an eye in a parsed picture.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/snapping.py``).
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from skimage.measure import find_contours

from toongeo.arrays import Floats
from toongeo.geometry.polyline import arc_length, interpolated
from toongeo.protocols import FaceLabel, FaceParse

__all__ = ["EyeBoundary", "eye_boundary"]

_FEWEST = 4  # px
_SOFT = 0.6  # px; smooths the stairs of a mask
_STEP = 0.25  # px between samples of the outline


@dataclass(frozen=True, eq=False)
class EyeBoundary:
    """Outline of a segmented eye.

    Attributes
    ----------
    ring : (n, 2) float64, px
        Closed, evenly sampled; the first point is not repeated.
    middle : (2,) float64, px
        Centroid of its pixels.
    confidence : float
        Mean over its pixels.
    raggedness : float
        Its length over that of its convex hull; 1 for convex outlines, little more for a slit that is bent.
    """

    ring: Floats
    middle: Floats
    confidence: float
    raggedness: float


def eye_boundary(parse: FaceParse, label: FaceLabel, near: Floats) -> EyeBoundary | None:
    """Outline of the piece of a part, of several the one that is large and near a point (2,) px; None without any."""
    ys, xs = np.nonzero(parse.labels == label)
    if len(xs) < _FEWEST:
        return None
    x0, y0, x1, y1 = xs.min() - 4, ys.min() - 4, xs.max() + 5, ys.max() + 5
    part = np.zeros((y1 - y0, x1 - x0), np.uint8)
    part[ys - y0, xs - x0] = 1
    _, pieces, stats, middles = cv2.connectedComponentsWithStats(part, connectivity=8)
    areas = stats[1:, cv2.CC_STAT_AREA].astype(np.float64)
    away = np.linalg.norm(middles[1:] + [x0, y0] - near, axis=1)
    best = 1 + int((np.sqrt(areas) - away).argmax())
    piece = (pieces == best).astype(np.uint8)
    ring = _outline(piece)
    if areas[best - 1] < _FEWEST or ring is None:
        return None
    hull = cv2.convexHull(ring.astype(np.float32))
    raggedness = cv2.arcLength(ring.astype(np.float32), True) / max(cv2.arcLength(hull, True), 1e-9)
    py, px = np.nonzero(piece)
    confidence = parse.confidence[py + y0, px + x0].mean()
    return EyeBoundary(ring + [x0, y0], middles[best] + [x0, y0], float(confidence), float(raggedness))


def _outline(piece: NDArray[np.uint8]) -> Floats | None:
    """Longest level line (n, 2), x and y, of the softened mask."""
    soft = cv2.GaussianBlur(piece.astype(np.float32), (0, 0), _SOFT)
    lines = find_contours(soft, 0.5)
    if not lines:
        return None
    line = max(lines, key=len)[:, ::-1]
    length = arc_length(line)
    samples = np.linspace(0, length[-1], max(int(length[-1] / _STEP), 8), endpoint=False)
    return interpolated(samples, length, line)
