"""Coordinates along and across the strands of hair that falls from the crown."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["StrandFrame"]

Floats = NDArray[np.floating]
_WHORL = np.deg2rad(20.0)  # by which the highest point of the hair's flow lies behind the top of the head


@dataclass(frozen=True, eq=False)
class StrandFrame:
    """A map of the head on which strands are upright lines: sinusoidal over a sphere, then straight down.

    Nothing is squeezed at the crown, where lines run from the forehead backwards; the map's cut lies in front, where
    the picture is.

    Attributes
    ----------
    centre : (3,) float64, mm, model frame
    radius : float, mm
    """

    centre: Floats
    radius: float

    @property
    def breadth(self) -> float:
        """mm across the map."""
        return 2 * np.pi * self.radius

    def at(self, points: Floats) -> tuple[Floats, Floats]:
        """Place across the map and way down from the crown (n,), mm, of points (n, 3) in the model frame."""
        c, s = np.cos(_WHORL), np.sin(_WHORL)
        x, y, z = (points - self.centre).T
        up, behind = c * y - s * z, -(s * y + c * z)
        out = np.hypot(x, behind)
        polar = np.where(up > 0, np.arctan2(out, np.maximum(up, 1e-9)), np.pi / 2)
        across = self.radius * (np.arctan2(x, behind) * np.sin(polar) + np.pi)
        return across, self.radius * polar - np.minimum(up, 0)
