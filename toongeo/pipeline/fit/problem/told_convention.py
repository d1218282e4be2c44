"""Whose definition of the landmarks the points of a picture follow: an annotator's, or that of a mesh of scans."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats
from toongeo.pipeline.fit.losses.total_loss import TotalLoss

__all__ = ["CONVENTIONS", "expected_minimum", "scans_tell"]

CONVENTIONS = ("auto", "annotators", "scans")
# Share of the loss below which the other definition must be expected to bring it. Projections of ICT-FaceKit subjects
# (seeds 1000-1029) come to 0.18-0.52, the portraits, drawings and caricatures looked at to 0.8-2.
_TELLING = 0.7


def scans_tell(annotators: TotalLoss, scans: TotalLoss, x: Floats, bounds: tuple[Floats, Floats]) -> Floats | None:
    """Where a fit goes on (n,) if its points follow the definition of scans, else None.

    Parameters
    ----------
    annotators, scans : TotalLoss
        The same but for where on the head the points are.
    x : (n,) float
        At the minimum of the first.
    bounds : two (n,) arrays
    """
    expected, there = expected_minimum(scans, x, bounds)
    return there if expected < _TELLING * annotators(x)[0] else None


def expected_minimum(loss: TotalLoss, x: Floats, bounds: tuple[Floats, Floats]) -> tuple[float, Floats]:
    """What a loss is expected to fall to from ``x`` (n,), and where.

    By one Gauss-Newton step of the unknowns that are not held by their bounds; it ends within these.
    """
    value, slope, matrix = loss.normal(x)
    free = (x > bounds[0]) & (x < bounds[1])
    step = np.zeros(len(x))
    step[free] = np.linalg.solve(matrix[np.ix_(free, free)], -slope[free])
    return float(value + slope @ step / 2), np.clip(x + step, *bounds)
