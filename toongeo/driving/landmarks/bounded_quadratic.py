"""The minimum of a small convex quadratic function in a box."""

import numpy as np

from toongeo.arrays import Floats

__all__ = ["bounded_quadratic"]

_ROUNDS = 100  # a variable, at most: a guard against endless loops


def bounded_quadratic(H: Floats, g: Floats, low: Floats, high: Floats, x: Floats) -> Floats:
    """Minimum of ``x H x / 2 - g x`` with ``low <= x <= high``.

    Primal active sets: the unknowns that are free go to their minimum, as far as the first bound that stands in the
    way, which then holds them; when none does, the bound whose multiplier has the wrong sign by most lets go.

    Parameters
    ----------
    H : (n, n) symmetric positive definite
    g : (n,)
    low, high : (n,), may be infinite
    x : (n,)
        Where to start; what is near the answer makes it quick.

    Returns
    -------
    (n,) float64

    References
    ----------
    J. Nocedal, S. J. Wright, "Numerical Optimization", 2nd ed., algorithm 16.3.

    Examples
    --------
    >>> bounded_quadratic(np.eye(2), np.array([3.0, 0.5]), np.zeros(2), np.ones(2), np.zeros(2))
    array([1. , 0.5])
    """
    x = np.clip(x, low, high)
    free = (x > low) & (x < high)
    tolerance = 1e-10 * (1.0 + np.abs(g).max(initial=0.0))
    for _ in range(_ROUNDS * (len(x) + 1)):
        target = x.copy()
        if free.any():
            rest = g[free] - H[np.ix_(free, ~free)] @ x[~free]
            target[free] = np.linalg.solve(H[np.ix_(free, free)], rest)
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
