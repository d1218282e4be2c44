"""What every weight and limit of an options object must be."""

from __future__ import annotations

import math
from numbers import Integral, Real
from typing import Any

__all__ = ["check_positive"]


def check_positive(name: str, value: Any, *, zero: bool = False, whole: bool = False) -> None:
    """Refuse what is not one finite positive number.

    Parameters
    ----------
    name : str
        Of the option, for the message.
    value
    zero : bool
        Whether 0 is allowed.
    whole : bool
        Whether it must be an integer.

    Raises
    ------
    ValueError
        If it is something else: text, a truth value, an array, NaN.

    Examples
    --------
    >>> check_positive("weight", 0.5)
    >>> check_positive("weight", "0.5")
    Traceback (most recent call last):
        ...
    ValueError: weight: expected a finite number > 0, got '0.5'
    """
    kind, wanted = (Integral, "an integer") if whole else (Real, "a finite number")
    fits = isinstance(value, kind) and not isinstance(value, bool) and math.isfinite(value)
    if not fits or value < 0 or (value == 0 and not zero):
        least = f">= {int(not zero)}" if whole else (">= 0" if zero else "> 0")
        raise ValueError(f"{name}: expected {wanted} {least}, got {value!r}")
