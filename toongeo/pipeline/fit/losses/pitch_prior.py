"""The prior on how far a head nods, and its gradient."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry.rotations.rotation_vectors import rotated, turn_of
from toongeo.pipeline.fit.frame.unknowns import Unknowns

__all__ = ["PitchPrior"]


@dataclass(frozen=True, eq=False)
class PitchPrior:
    """``(u / s)^2`` with the component u of the head's up axis towards the viewer: the sine of the pitch over s.

    People in pictures look up or down by a few degrees. From the front a long nose is also a nodding head, and an
    exaggerated drawing is otherwise explained by a pose that nobody would draw. Turning and tilting cost nothing.

    Attributes
    ----------
    unknowns : Unknowns
    rotation0 : (3, 3) float
        R0 of `LandmarkLoss`.
    deviation : float, degrees
        Standard deviation s of the pitch.
    """

    unknowns: Unknowns
    rotation0: Floats
    deviation: float

    def __call__(self, x: Floats) -> tuple[float, Floats]:
        """Value and gradient (n,) at ``x`` (n,)."""
        up, slope = self._up(x)
        gradient = np.zeros(self.unknowns.size)
        gradient[self.unknowns.rotation] = np.multiply(2 * self._weight * up, slope)
        return self._weight * up**2, gradient

    def curvature(self, x: Floats) -> Floats:
        """Diagonal (n,) of the Gauss-Newton matrix."""
        curvature = np.zeros(self.unknowns.size)
        curvature[self.unknowns.rotation] = 2 * self._weight * np.square(self._up(x)[1])
        return curvature

    def normal(self, x: Floats) -> tuple[float, Floats, Floats]:
        """Value, and gradient (3,) and Gauss-Newton matrix (3, 3) by the rotation, on which alone it depends."""
        up, slope = self._up(x)
        turn = np.array(slope)
        return self._weight * up**2, 2 * self._weight * up * turn, 2 * self._weight * np.outer(turn, turn)

    @property
    def _weight(self) -> float:
        return float(1 / np.radians(self.deviation) ** 2)

    def _up(self, x: Floats) -> tuple[float, tuple[float, float, float]]:
        """u, and its derivative by the rotation vector."""
        w = x[self.unknowns.rotation]
        right, height, towards = rotated(w, self.rotation0[:, 1])
        return towards, turn_of(w, (height, -right, 0.0))  # a turn by the small vector d adds d x up
