"""Coordinates along and across the strands of hair that falls from the crown."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["StrandFrame"]

Floats = NDArray[np.floating]
_WHORL = np.deg2rad(30.0)  # by which the whorl lies behind the top of the head


@dataclass(frozen=True, eq=False)
class StrandFrame:
    """Strands run from the whorl over a sphere down to its equator, then straight down.

    Attributes
    ----------
    centre : (3,) float64, mm, model frame
    radius : float, mm
    """

    centre: Floats
    radius: float

    def at(self, points: Floats) -> tuple[Floats, Floats]:
        """Way around the head and way from the whorl (n,), mm, of points (n, 3) in the model frame."""
        c, s = np.cos(_WHORL), np.sin(_WHORL)
        x, y, z = (points - self.centre).T
        up, ahead = c * y - s * z, s * y + c * z
        across = np.arctan2(x, ahead) * self.radius
        out = np.hypot(x, ahead)
        along = np.where(up > 0, self.radius * np.arctan2(out, np.maximum(up, 1e-9)), self.radius * np.pi / 2 - up)
        return across, along
