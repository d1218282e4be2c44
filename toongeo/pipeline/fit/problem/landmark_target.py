"""What a landmark fit aims at, and where it may look."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats

__all__ = ["LandmarkTarget", "SearchBox"]


@dataclass(frozen=True, eq=False)
class LandmarkTarget:
    """The points of a picture that are to be met.

    Attributes
    ----------
    pixels : (68, 2) or (k, 2) float, px
        As they came, NaN rows missing.
    seen : (k,) int
        Landmarks that are there.
    points : (k, 2) float
        These in the canonical frame, mm.
    weights : (k, 2, 2) float, 1/mm^2
        Their weights in Eq. 4, with errors in outer-eye distances.
    offsets : (68, 3) float, mm, model frame
        From the landmarks of the model to where the points are.
    scan_offsets : (68, 3) float, mm, model frame, or None
        The same for points of a mesh of scans; None: it is settled whose they are.
    convention : {"annotators", "scans"}
        Whose definition ``offsets`` follow.
    own : mean (k, 3) and modes (3 k, c), or None
        Landmarks of the caller's own table, which do not slide.
    neighbours : (k, k) bool
    robust_weight : (k,) float
        Robust weights with which the first pass begins.
    """

    pixels: Floats
    seen: NDArray[np.int64]
    points: Floats
    weights: Floats
    offsets: Floats
    own: tuple[Floats, Floats] | None
    neighbours: NDArray[np.bool_]
    robust_weight: Floats
    scan_offsets: Floats | None = None
    convention: str = "annotators"

    @property
    def count(self) -> int:
        """N of Eq. 4: a point that is missing counts."""
        return len(self.pixels)


@dataclass(frozen=True, eq=False)
class SearchBox:
    """Where the unknowns begin, and what they may not leave.

    Attributes
    ----------
    start : (n,) float
    bounds : two (n,) arrays
        Lower and upper.
    opposites : (p, 2) int
        Unknowns of which at most one is above zero.
    """

    start: Floats
    bounds: tuple[Floats, Floats]
    opposites: NDArray[np.int64]
