"""Points out of parsed JSON."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.io.landmarks.landmark_schemes import SCHEMES

__all__ = ["json_number", "json_points"]

_COUNTS = frozenset(count for counts in SCHEMES.values() for count in counts)
_MOST_POINTS = 10_000  # of one face; the largest scheme has 478


def json_number(value: Any) -> float | None:
    """A number, NaN for null, None for anything else: truth values, text, and integers beyond all floats."""
    if value is None:
        return float("nan")
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        return float(value)
    except OverflowError:
        return None


def json_points(node: Any) -> NDArray[np.float64] | None:
    """Points (k, 2 or 3) if the node is a list of points, else None.

    A point is ``[x, y]`` or ``[x, y, z]``, ``{"x": x, "y": y}``, or null where it is missing; all may stand in an
    object under their numbers ``"0"``, ``"1"`` ..., and the coordinates in ``{"x": [...], "y": [...]}``.
    """
    if isinstance(node, dict):
        if {"x", "y"} <= node.keys() and isinstance(node["x"], list) and isinstance(node["y"], list):
            if len(node["x"]) != len(node["y"]):
                return None
            node = [list(pair) for pair in zip(node["x"], node["y"], strict=True)]
        elif node and all(key.isdecimal() and len(key) < 6 and int(key) < _MOST_POINTS for key in node):
            numbered = {int(key): point for key, point in node.items()}
            first = int(0 not in numbered and max(numbered) in _COUNTS)  # counted from 0, or from 1
            node = [numbered.get(k) for k in range(first, max(numbered) + 1)]
    if not isinstance(node, list) or not node or len(node) > _MOST_POINTS:
        return None
    rows = [_point(point) for point in node]
    lengths = {len(row) for row in rows if row}
    if None in rows or len(lengths) != 1:
        return None
    width = lengths.pop()
    return np.array([row or [np.nan] * width for row in rows], np.float64)


def _point(node: Any) -> list[float] | None:
    """Two or three numbers; none for a missing point; None for anything else."""
    if node is None:
        return []
    if isinstance(node, dict):
        node = [node[axis] for axis in "xyz" if axis in node] if {"x", "y"} <= node.keys() else None
    if not isinstance(node, list) or len(node) not in (2, 3):
        return None
    numbers = [json_number(value) for value in node]
    return None if None in numbers else numbers  # type: ignore[return-value]
