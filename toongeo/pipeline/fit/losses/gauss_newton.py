"""Minimum of a sum of squares within bounds, by steps that know how the unknowns depend on each other."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry.operators.bounded_quadratic import bounded_quadratic
from toongeo.pipeline.fit.losses.nlopt_minimize import Minimum

__all__ = ["GAUSS_NEWTON", "SquaresLoss", "gauss_newton"]

GAUSS_NEWTON = "gauss-newton"
"""What `fit_3dmm` calls this minimiser."""
_HALVINGS = 12  # of a step that does not lower the loss; a shorter one is lost in rounding
_SLOW = 0.1  # of what a step promises, what the next one does: those of photographs fall to 0.02 and less
_ENOUGH = 0.1  # share of the fall that the quadratic model promises; Nocedal and Wright, section 3.1, take 1e-4 to 0.1


class SquaresLoss(Protocol):
    """A loss that knows its second derivative, or nearly."""

    def __call__(self, x: Floats) -> tuple[float, Floats]:
        """Value and gradient (n,) at ``x`` (n,)."""

    def normal(self, x: Floats, *, bent: bool = False) -> tuple[float, Floats, Floats]:
        """Value, gradient (n,) and a matrix (n, n) at ``x`` (n,): that of Gauss and Newton, or nearer to the truth."""


def gauss_newton(
    loss: SquaresLoss,
    start: Floats,
    *,
    bounds: tuple[Floats, Floats],
    tolerance: float = 1e-8,
    max_evaluations: int = 1000,
    max_seconds: float | None = None,
) -> Minimum:
    """Minimum of a smooth sum of squares within bounds.

    Each step leads to the minimum of a quadratic model in the box, or a part of the way there; all on it is in the
    box. Where they become slow, as in a drawing, which misses its points by much, the model has the bent matrix of
    the loss, which is dearer, as long as that is positive definite.

    Parameters
    ----------
    loss : SquaresLoss
    start : (n,) float
        Moved into the bounds where it is outside.
    bounds : two (n,) arrays
        Lower and upper; equal ones hold a variable.
    tolerance : float
        Relative change of the value at which to stop: what the next step promises, or seems about to.
    max_evaluations : int
        Of the loss and its matrix.
    max_seconds : float, optional

    References
    ----------
    J. Nocedal, S. J. Wright, "Numerical Optimization", 2nd ed., sections 10.3 and 16.7.
    """
    ends = np.inf if max_seconds is None else time.perf_counter() + max_seconds
    x = np.clip(start, *bounds)
    value, slope, matrix = loss.normal(x)
    evaluations, before, bent = 1, None, False
    while True:
        step = _step(slope, matrix, x, bounds) or _step(slope, loss.normal(x)[2], x, bounds)
        if step is None or step.promised <= tolerance * abs(value):
            return Minimum(x, value, "FTOL_REACHED", evaluations)
        rate = 1.0 if before is None else step.promised / before
        bent |= before is not None and rate > _SLOW
        last = rate * step.promised <= tolerance * abs(value)  # what the step after this one would promise
        for share in 0.5 ** np.arange(_HALVINGS):
            there = _moved(x, step.way, share, bounds)
            after, *around = loss(there) if last else loss.normal(there, bent=bent)
            evaluations += 1
            if after <= value - _ENOUGH * share * step.promised:
                break
            if evaluations >= max_evaluations:
                return Minimum(x, value, "MAXEVAL_REACHED", evaluations)
            last = False
        else:
            return Minimum(x, value, "ROUNDOFF_LIMITED", evaluations)
        x, value, before = there, after, step.promised
        if last:
            return Minimum(x, value, "FTOL_REACHED", evaluations)
        slope, matrix = around
        if evaluations >= max_evaluations or time.perf_counter() > ends:
            status = "MAXEVAL_REACHED" if evaluations >= max_evaluations else "MAXTIME_REACHED"
            return Minimum(x, value, status, evaluations)


@dataclass(frozen=True, eq=False)
class _Step:
    """A way (n,), and how far the loss falls on it by its quadratic model."""

    way: Floats
    promised: float


def _step(slope: Floats, matrix: Floats, x: Floats, bounds: tuple[Floats, Floats]) -> _Step | None:
    """To the minimum of the quadratic model in the box; None where the model has none.

    Unknowns are scaled to a diagonal of ones, since a radian and a millimetre are not alike.
    """
    scale = 1 / np.sqrt(np.abs(matrix.diagonal()))
    scaled = matrix * scale * scale[:, None]
    low, high = ((bound - x) / scale for bound in bounds)
    pull = -slope * scale
    try:
        z = bounded_quadratic(scaled, pull, low, high, np.zeros(len(x)))
    except np.linalg.LinAlgError:
        return None
    way = np.where(z <= low, bounds[0] - x, np.where(z >= high, bounds[1] - x, z * scale))
    return _Step(way, float(z @ (pull - scaled @ z / 2)))


def _moved(x: Floats, step: Floats, share: float, bounds: tuple[Floats, Floats]) -> Floats:
    """Some of the way; who arrives at a bound is on it to the bit, so that the next step sees it there."""
    there = x + share * step
    for bound in bounds:
        there = np.where(np.abs(there - bound) <= 1e-12, bound, there)
    return np.clip(there, *bounds)
