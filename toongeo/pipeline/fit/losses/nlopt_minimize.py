"""nlopt behind one function: bounds, scaled variables, and exceptions that say what happened."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import nlopt
import numpy as np

from toongeo.arrays import Floats

__all__ = ["Minimum", "known_algorithms", "nlopt_minimize"]

_SUCCESSES = (
    "SUCCESS",
    "STOPVAL_REACHED",
    "FTOL_REACHED",
    "XTOL_REACHED",
    "MAXEVAL_REACHED",
    "MAXTIME_REACHED",
)
_STATUS = {getattr(nlopt, name): name for name in _SUCCESSES}
# These wrap another optimizer, or were not compiled in.
_UNUSABLE = ("AUGLAG", "MLSL", "NOCEDAL")


@dataclass(frozen=True, eq=False)
class Minimum:
    """The best point (n,) met, its value, nlopt's status by name and how often the objective was called."""

    x: Floats
    value: float
    status: str
    evaluations: int


@cache
def known_algorithms() -> tuple[str, ...]:
    """Names of the nlopt algorithms that can be asked for, such as ``"LD_LBFGS"``."""
    names = [name for name in dir(nlopt) if name.startswith(("LD_", "LN_", "GD_", "GN_"))]
    return tuple(name for name in names if not any(part in name for part in _UNUSABLE))


def nlopt_minimize(
    objective: Callable[[Floats], tuple[float, Floats]],
    start: Floats,
    *,
    bounds: tuple[Floats, Floats],
    scale: Floats,
    algorithm: str = "LD_LBFGS",
    tolerance: float = 1e-8,
    max_evaluations: int = 1000,
    max_seconds: float | None = None,
) -> Minimum:
    """Minimum of a smooth function within bounds.

    Parameters
    ----------
    objective : callable
        Value and gradient (n,) at a point (n,).
    start : (n,) float
        Moved into the bounds where it is outside.
    bounds : two (n,) arrays
        Lower and upper; equal ones hold a variable.
    scale : (n,) float > 0
        Size of a typical step of each variable; the optimizer sees ``x / scale``.
    algorithm : str
        One of `known_algorithms`.
    tolerance : float
        Relative change of the value at which to stop.
    max_evaluations : int
    max_seconds : float, optional

    Raises
    ------
    ValueError
        If the algorithm is not known or the bounds contradict each other.
    RuntimeError
        If nlopt fails; the message holds the algorithm, the reason and the number of evaluations.
    """
    if algorithm not in known_algorithms():
        raise ValueError(f"algorithm: no algorithm {algorithm!r}; known: {', '.join(known_algorithms())}")
    lower, upper = bounds
    if not (lower <= upper).all():
        k = int(np.argmax(~(lower <= upper)))
        raise ValueError(f"bounds: expected lower <= upper, got {lower[k]} > {upper[k]} for variable {k}")
    recorder = _Recorder(objective, scale)
    optimizer = nlopt.opt(getattr(nlopt, algorithm), len(start))
    optimizer.set_lower_bounds(lower / scale)
    optimizer.set_upper_bounds(upper / scale)
    optimizer.set_min_objective(recorder)
    optimizer.set_ftol_rel(tolerance)
    optimizer.set_maxeval(max_evaluations)
    optimizer.set_maxtime(max_seconds or 0.0)  # 0 is no limit
    nlopt.srand(0)  # for the stochastic ones; the same call gives the same answer
    try:
        optimizer.optimize(np.clip(start / scale, lower / scale, upper / scale))
        status = _STATUS.get(optimizer.last_optimize_result())
        reason = "no success"
    except nlopt.RoundoffLimited:
        status = "ROUNDOFF_LIMITED"  # no further progress in floating point: the best point met is the answer
    except Exception as error:
        if recorder.error is not None:
            raise recorder.error from None
        status, reason = None, str(error) or type(error).__name__
    if status is None or not np.isfinite(recorder.best_value):
        raise RuntimeError(
            f"{algorithm}: nlopt failed ({reason if status is None else 'the objective was never finite'}, "
            f"result {optimizer.last_optimize_result()}) after {recorder.evaluations} evaluations"
        )
    x = _on_bounds(recorder.best_x, lower, upper)
    return Minimum(x, recorder.best_value, status, recorder.evaluations)


def _on_bounds(x: Floats, lower: Floats, upper: Floats) -> Floats:
    """Variables that the scaling has moved off a bound by a rounding error, back on it.

    A later start from there would otherwise see a free variable or a held one as chance has it.
    """
    x = np.clip(x, lower, upper)
    for bound in (lower, upper):
        x = np.where(np.abs(x - bound) <= 1e-12, bound, x)
    return x


class _Recorder:
    """The objective as nlopt wants it; keeps the best point, which nlopt loses when it raises."""

    def __init__(self, objective: Callable[[Floats], tuple[float, Floats]], scale: Floats) -> None:
        self.objective, self.scale = objective, scale
        self.best_x, self.best_value = np.empty(0), np.inf
        self.evaluations = 0
        self.error: Exception | None = None

    def __call__(self, z: Floats, gradient: Floats) -> float:
        self.evaluations += 1
        x = z * self.scale
        try:
            value, slope = self.objective(x)
        except Exception as error:
            self.error = error
            raise
        if gradient.size:
            gradient[:] = slope * self.scale
        if value < self.best_value:
            self.best_value, self.best_x = value, x
        return float(value)
