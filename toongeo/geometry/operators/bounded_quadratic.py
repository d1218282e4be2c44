"""The minimum of a small convex quadratic function in a box."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dposv

from toongeo.arrays import Floats

__all__ = ["bounded_quadratic"]

_ROUNDS = 100  # a variable, at most: a guard against endless loops
_AT_ONCE = 12  # rounds in which many bounds change; where these end at all they do after 2 to 6


def bounded_quadratic(H: Floats, g: Floats, low: Floats, high: Floats, x: Floats) -> Floats:
    """Minimum of ``x H x / 2 - g x`` with ``low <= x <= high``.

    First all bounds change at once: the unknowns that are free go to their minimum, those that land outside are held,
    and those whose multiplier has the wrong sign let go, until nothing changes. That takes few rounds, but may go
    in circles. Then primal active sets: the free unknowns go as far as the first bound that stands in the way, which
    holds them; when none does, the bound whose multiplier has the wrong sign by most lets go.

    Parameters
    ----------
    H : (n, n) symmetric positive definite
        At least in the unknowns that are free.
    g : (n,)
    low, high : (n,), may be infinite
    x : (n,)
        Where to start. Of it counts what lies on a bound: the answer's bounds, or nearly, make it quick.

    Returns
    -------
    (n,) float64

    Raises
    ------
    numpy.linalg.LinAlgError
        If H is found not to be positive definite.

    References
    ----------
    M. Hintermüller, K. Ito, K. Kunisch, "The primal-dual active set strategy as a semismooth Newton method", SIAM J.
    Optim. 13, 2002. J. Nocedal, S. J. Wright, "Numerical Optimization", 2nd ed., algorithm 16.3.

    Examples
    --------
    >>> bounded_quadratic(np.eye(2), np.array([3.0, 0.5]), np.zeros(2), np.ones(2), np.zeros(2))
    array([1. , 0.5])
    """
    x = np.clip(x, low, high)
    tolerance = 1e-10 * (1.0 + np.abs(g).max(initial=0.0))
    answer = _all_at_once(H, g, low, high, x, tolerance)
    return _one_by_one(H, g, low, high, x, tolerance) if answer is None else answer


def _all_at_once(H: Floats, g: Floats, low: Floats, high: Floats, x: Floats, tolerance: float) -> Floats | None:
    """The minimum, or None if the sets of held unknowns do not settle."""
    below, above = x <= low, (x >= high) & (low < high)
    for _ in range(_AT_ONCE):
        free = ~(below | above)
        x = np.where(below, low, np.where(above, high, 0.0))
        x[free] = _free_minimum(H, g, x, free)
        slope = H @ x - g
        lower = np.where(below, (slope >= -tolerance) | (low == high), x < low)
        upper = np.where(above, slope <= tolerance, x > high)
        if (lower == below).all() and (upper == above).all():
            return x
        below, above = lower, upper
    return None


def _one_by_one(H: Floats, g: Floats, low: Floats, high: Floats, x: Floats, tolerance: float) -> Floats:
    """The minimum, by descents from ``x`` that each change one bound."""
    free = (x > low) & (x < high)
    for _ in range(_ROUNDS * (len(x) + 1)):
        target = x.copy()
        if free.any():
            target[free] = _free_minimum(H, g, np.where(free, 0.0, x), free)
        move = target - x
        room = np.full(len(x), np.inf)
        down, up = free & (target < low), free & (target > high)
        room[down] = (low - x)[down] / move[down]
        room[up] = (high - x)[up] / move[up]
        first = int(room.argmin())
        if room[first] < np.inf:
            x = np.clip(x + room[first] * move, low, high)
            x[first] = low[first] if down[first] else high[first]
            free[first] = False
            continue
        x = target
        slope = H @ x - g
        # At the lower bound the slope must not fall, at the upper one not rise.
        wrong = np.where(free, 0.0, np.where(x <= low, -slope, slope))
        wrong[low >= high] = 0.0
        worst = int(wrong.argmax())
        if wrong[worst] <= tolerance:
            return x
        free[worst] = True
    return x  # rounding lets bounds come and go; every round has been a descent


def _free_minimum(H: Floats, g: Floats, held: Floats, free: NDArray[np.bool_]) -> Floats:
    """Where the free unknowns have their minimum beside those that are held; ``held`` is zero at the free ones."""
    F = np.flatnonzero(free)
    block, rest = H.take(F, axis=0).take(F, axis=1), (g - H @ held)[F]
    if not len(F):
        return rest
    _, x, failed = dposv(block, rest)  # half the work of np.linalg.solve, and less of a call
    if failed:
        raise np.linalg.LinAlgError("H: expected a positive definite matrix")
    return x
