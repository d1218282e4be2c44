"""Whether the gradient of a loss is that of its values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.arrays import Floats

__all__ = ["GradientCheck", "check_gradient"]

_DIRECTIONS = 5
_STEPS = (1e-2, 1e-3, 1e-4)  # at smaller ones rounding is as large as what is looked at
_ROUNDING = 100 * np.finfo(float).eps  # of the values: a remainder below has no slope
_TOLERANCE = 0.1  # by which the slope of a right gradient may fall short of 2 where a third derivative joins in


@dataclass(frozen=True, eq=False)
class GradientCheck:
    """How the remainder of a linear expansion vanishes.

    Attributes
    ----------
    steps : (s,) float64
        Lengths h, the longest first.
    remainders : (k, s) float64
        ``|f(x + h d) - f(x) - h g . d|`` along each direction d.
    slopes : (k,) float64
        Order at which it vanishes between the two shortest steps that are not lost in rounding: 2 (or more) if the
        gradient is right, 1 if it is wrong; infinite where no remainder is left to see.
    passed : bool
        Whether all slopes are those of a right gradient.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> right = tg.check_gradient(lambda x: (float((x**3).sum()), 3 * x**2), np.array([0.3, 1.0]))
    >>> wrong = tg.check_gradient(lambda x: (float((x**3).sum()), x**2), np.array([0.3, 1.0]))
    >>> right.passed, wrong.passed
    (True, False)
    >>> right.remainders.shape == (len(right.slopes), len(right.steps))
    True
    """

    steps: Floats
    remainders: Floats
    slopes: Floats
    passed: bool

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "steps", "remainders", "slopes")


def check_gradient(
    loss: Callable[[Floats], tuple[float, Floats]],
    x: ArrayLike,
    directions: ArrayLike | None = None,
    *,
    steps: Sequence[float] = _STEPS,
    rng: np.random.Generator | None = None,
) -> GradientCheck:
    """Compare the gradient of a loss with its values, by the slope of the remainder of Taylor's expansion.

    Unlike a comparison with finite differences, this has no tolerance that depends on the scale of the loss.

    Parameters
    ----------
    loss : callable
        ``loss(x) -> (value, gradient (n,))``.
    x : (n,) float
        Where to look; not at a kink, and not where the gradient is 0, which says little.
    directions : (n,) or (k, n) float, optional
        Along which to look, as long as a change of x that matters; by default 5 of length 1, drawn from ``rng``.
    steps : sequence of float
        Shares of the directions, at least two, positive.
    rng : numpy.random.Generator, optional
        ``default_rng(0)`` if None.

    Returns
    -------
    GradientCheck

    Raises
    ------
    ValueError
        If x or a direction is not of these shapes or not finite, the steps are not two or more positive numbers, or the
        loss gives a gradient of another shape, or numbers that are not finite.

    Examples
    --------
    >>> def loss(x):
    ...     return float(np.sin(x).sum()), np.cos(x)
    >>> check_gradient(loss, [0.3, 1.0]).passed
    True
    >>> wrong = check_gradient(lambda x: (loss(x)[0], 1.01 * loss(x)[1]), [0.3, 1.0])
    >>> wrong.passed, bool((wrong.slopes < 1.3).all())
    (False, True)
    """
    x = np.array(x, np.float64)
    if x.ndim != 1 or not np.isfinite(x).all():
        raise ValueError(f"x: expected finite numbers (n,), got shape {x.shape}")
    if directions is None:
        rng = np.random.default_rng(0) if rng is None else rng
        along = rng.standard_normal((_DIRECTIONS, len(x)))
        along /= np.linalg.norm(along, axis=1, keepdims=True)
    else:
        along = np.atleast_2d(np.asarray(directions, np.float64))
    if along.ndim != 2 or along.shape[1:] != x.shape or not np.isfinite(along).all():
        raise ValueError(f"directions: expected finite numbers (n,) or (k, n) with n = {len(x)}, got {along.shape}")
    h = np.sort(np.asarray(steps, np.float64))[::-1]
    if h.ndim != 1 or len(h) < 2 or not (np.isfinite(h).all() and h[-1] > 0 and (np.diff(h) < 0).all()):
        raise ValueError(f"steps: expected at least two different positive numbers, got {steps!r}")
    value, gradient = _evaluated(loss, x)
    moved = np.array([[_evaluated(loss, x + step * d)[0] for step in h] for d in along])
    linear = h * (along @ gradient)[:, None]
    remainders = np.abs(moved - value - linear)
    floor = _ROUNDING * (abs(value) + np.abs(moved) + np.abs(linear))
    slopes = np.array([_slope(h, row, row > least) for row, least in zip(remainders, floor, strict=True)])
    return GradientCheck(h, remainders, slopes, bool((slopes >= 2 - _TOLERANCE).all()))


def _evaluated(loss: Callable[[Floats], tuple[float, Floats]], x: Floats) -> tuple[float, Floats]:
    value, gradient = loss(x.copy())
    gradient = np.asarray(gradient, np.float64)
    if gradient.shape != x.shape:
        raise ValueError(f"loss: expected a gradient of shape {x.shape}, got {gradient.shape}")
    if not (np.isfinite(value) and np.isfinite(gradient).all()):
        raise ValueError("loss: expected finite value and gradient, got NaN or infinity")
    return float(value), gradient


def _slope(h: Floats, remainder: Floats, telling: np.ndarray) -> float:
    """Between the two shortest steps that tell something; with fewer all that is left is rounding."""
    seen = np.flatnonzero(telling)
    if len(seen) < 2:
        return np.inf
    last, before = seen[-1], seen[-2]
    return float(np.log(remainder[before] / remainder[last]) / np.log(h[before] / h[last]))
