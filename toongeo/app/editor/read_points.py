"""Points of a message."""

import numpy as np

from toongeo.arrays import Floats

__all__ = ["read_points"]

_FARTHEST_PX = 1e6  # from the picture; a slip of the hand goes nowhere near


def read_points(value: object, name: str = "points") -> Floats:
    """Landmarks (68, 2) px of a list of 68 entries, each ``[x, y]``, or None where the point is missing.

    Raises
    ------
    ValueError
        If it is anything else.

    Examples
    --------
    >>> read_points([[1, 2.5]] + [None] * 67)[:2]
    array([[1. , 2.5],
           [nan, nan]])
    """
    if not isinstance(value, list) or len(value) != 68:
        got = f"{len(value)} entries" if isinstance(value, list) else str(value)[:60]
        raise ValueError(f"{name}: expected a list of 68 points, got {got}")
    points = np.full((68, 2), np.nan)
    for k, entry in enumerate(value):
        if entry is None:
            continue
        if not (isinstance(entry, list) and len(entry) == 2 and all(_is_pixel(number) for number in entry)):
            raise ValueError(f"{name}: expected [x, y] in px or null, got {str(entry)[:60]} for point {k}")
        points[k] = entry
    return points


def _is_pixel(number: object) -> bool:
    return isinstance(number, int | float) and not isinstance(number, bool) and abs(number) <= _FARTHEST_PX
