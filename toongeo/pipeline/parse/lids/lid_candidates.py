"""Where the lids may be, given landmarks that are shifted or shrunken.

Constants were chosen on the seven examples and 15 caricatures (``benchmarks/snapping.py``).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from toongeo.arrays import Floats
from toongeo.geometry.polyline import arc_length
from toongeo.pipeline.parse.lids.lid_patch import RESOLUTION

__all__ = ["ARC", "LidCandidates", "lid_candidates", "lid_contour"]

ARC = 16  # samples of a lid, the first corner among them
_GROWTHS = np.array([-0.03, 0.0, 0.03, 0.06, 0.09, 0.12])  # outer-eye distances at the farthest point
_REACH, _STEP = 0.141, 0.02  # outer-eye distances: how far, and how finely, shifts are tried
_HEIGHTS = np.array([1.0, 1.5])  # drawn eyes are often taller than detectors take them to be
_LEAST = 0.5  # of the given size


@dataclass(frozen=True, eq=False)
class LidCandidates:
    """Shifted and scaled copies of one contour; ``contours[k] = middle + shift[k] + scale[k] * (given - middle)``.

    Attributes
    ----------
    contours : (k, 32, 2) float64, px of the patch
    shifts : (k, 2) float64, px
    scales : (k, 2) float64
        Across and along the height of the upright patch.
    growths : (k,) float64
        Outer-eye distances that the farthest point moves out by.
    radius : float
        Outer-eye distances from the middle to the farthest given point.
    """

    contours: Floats
    shifts: Floats
    scales: Floats
    growths: Floats
    radius: float


def lid_contour(lids: Floats) -> Floats:
    """Closed curve (32, 2) through six lid points: the upper lid from its first corner, then the lower one back."""
    ring = np.vstack([lids, lids[:1]])
    return np.vstack([_curve(ring[:4]), _curve(ring[3:])])


def lid_candidates(contour: Floats) -> LidCandidates:
    """Candidates about a given contour (32, 2) px of the patch."""
    middle = contour.mean(axis=0)
    radius = max(float(np.linalg.norm(contour - middle, axis=1).max()) / RESOLUTION, 1e-3)
    reach = np.arange(-int(_REACH / _STEP), int(_REACH / _STEP) + 1) * _STEP
    grid = np.stack(np.meshgrid(reach, reach), axis=2).reshape(-1, 2)
    grid = grid[np.hypot(*grid.T) <= _REACH] * RESOLUTION
    sizes = np.stack(np.meshgrid(_HEIGHTS, _GROWTHS), axis=2).reshape(-1, 2)
    heights, growths = np.repeat(sizes, len(grid), axis=0).T
    shifts = np.tile(grid, (len(sizes), 1))
    scales = np.maximum(_LEAST, (radius + growths) / radius)[:, None] * np.column_stack(
        [np.ones_like(heights), heights]
    )
    contours = middle + shifts[:, None] + scales[:, None] * (contour - middle)
    return LidCandidates(contours, shifts, scales, growths, radius)


def _curve(points: Floats) -> Floats:
    """Samples (16, 2) of a curve through a lid's points, without its end.

    Monotone pieces: a cubic spline bulges far out where an eye is taller than wide.
    """
    length = arc_length(points, least=1e-6)
    return PchipInterpolator(length, points)(np.linspace(0, length[-1], ARC, endpoint=False))
