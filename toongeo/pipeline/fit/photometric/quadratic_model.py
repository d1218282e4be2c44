"""A loss to second order around a point."""

from __future__ import annotations

from dataclasses import dataclass

from toongeo.arrays import Floats

__all__ = ["QuadraticModel"]


@dataclass(frozen=True, eq=False)
class QuadraticModel:
    """``value + g.d + d.H d / 2`` of the step ``d = z - centre``: a function of ``z`` (n,).

    Attributes
    ----------
    centre : (n,) float
    value : float
    gradient : (n,) float
        g.
    matrix : (n, n) float
        H, symmetric.
    """

    centre: Floats
    value: float
    gradient: Floats
    matrix: Floats

    def __call__(self, z: Floats) -> tuple[float, Floats]:
        """Value and gradient (n,) at ``z`` (n,)."""
        step = z - self.centre
        bent = self.matrix @ step
        return self.value + float(step @ (self.gradient + bent / 2)), self.gradient + bent
