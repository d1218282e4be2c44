"""Curves through landmarks."""

import numpy as np

from toongeo.arrays import Floats

__all__ = ["curve", "faired", "taper", "unit"]


def curve(points: Floats, samples: int = 12) -> Floats:
    """Catmull-Rom spline through points (k, 2): ((k - 1) samples + 1, 2)."""
    points = np.asarray(points, np.float64)
    padded = np.vstack([2 * points[0] - points[1], points, 2 * points[-1] - points[-2]])
    t = np.linspace(0, 1, samples, endpoint=False)[:, None]
    pieces = []
    for a, b, c, d in zip(padded, padded[1:], padded[2:], padded[3:], strict=False):
        pieces.append((2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3) / 2)
    return np.vstack([*pieces, points[-1:]])


def faired(line: Floats, radius: int) -> Floats:
    """A line (k, 2) smoothed by a Hann window of 2 radius + 1 points; its ends stay."""
    window = np.hanning(2 * radius + 3)[1:-1]
    padded = np.pad(line, ((radius, radius), (0, 0)), mode="reflect", reflect_type="odd")
    return np.stack([np.convolve(padded[:, i], window / window.sum(), "valid") for i in (0, 1)], axis=1)


def taper(count: int, first: float, last: float, power: float = 0.7) -> Floats:
    """Widths (count,): 1 in the middle, falling to 0 over these shares of the length at the ends."""
    t = np.linspace(0, 1, count)
    return np.asarray((np.clip(t / first, 0, 1) * np.clip((1 - t) / last, 0, 1)) ** power)


def unit(vector: Floats) -> Floats:
    """The vector at length 1."""
    return np.asarray(vector / max(float(np.linalg.norm(vector)), 1e-9))
