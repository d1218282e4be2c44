"""Other landmark schemes as iBUG-68: ``SCHEMES`` maps a name to its numbers of points; tables in ``data_templates/``.

>>> SCHEMES["wflw98"], SCHEMES["mediapipe478"]
((98,), (478, 468))
"""

import csv
from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo._data_path import data_path
from toongeo.io.landmark_array import landmark_array
from toongeo.io.landmarks.frontal_layout import frontal_layout, frontal_pose
from toongeo.io.point_array import point_array

__all__ = ["SCHEMES", "ibug_points", "scheme_of"]

_Floats = NDArray[np.float64]

SCHEMES: Mapping[str, tuple[int, ...]] = MappingProxyType(
    {
        "ibug68": (68,),
        "ibug51": (51,),  # without the jaw
        "ibug49": (49,),  # without the jaw and the inner mouth corners
        "openpose70": (70,),  # with the two pupils
        "wflw98": (98,),
        "lapa106": (106,),
        "sensetime106": (106,),
        "insightface106": (106,),
        "wholebody133": (133,),  # 17 of the body, 6 of the feet, 68 of the face, 42 of the hands
        "mediapipe478": (478, 468),  # with and without the irises
    }
)
_BODY_AND_FEET = 23
_JAW = 17
_INNER_MOUTH_CORNERS = (60, 64)


def scheme_of(points: _Floats, name: str = "landmarks") -> str:
    """Which scheme points (k, 2) px have, by their number; of several with the same number the one that forms a face.

    Raises
    ------
    ValueError
        If no scheme has that number of points.
    """
    found = [scheme for scheme, counts in SCHEMES.items() if len(points) in counts]
    if not found:
        landmark_array(points, name)  # says what the number is known for
    return found[0] if len(found) == 1 else min(found, key=lambda scheme: _misfit(points, scheme))


def ibug_points(points: ArrayLike, scheme: str, name: str = "landmarks") -> _Floats:
    """The 68 points (68, 2) px out of those of a scheme; what it does not have is NaN.

    Raises
    ------
    ValueError
        If the scheme is not known or its number of points is another, they are not numbers, one is infinite or half
        missing, or all are missing.

    Examples
    --------
    >>> ibug_points(np.arange(196.0).reshape(98, 2), "wflw98")[[0, 1, 36]]
    array([[  0.,   1.],
           [  4.,   5.],
           [120., 121.]])
    """
    if scheme not in SCHEMES:
        raise ValueError(f"scheme: expected one of {', '.join(map(repr, SCHEMES))}, got {scheme!r}")
    if scheme == "ibug68":
        return landmark_array(points, name)  # says more about another shape
    array = point_array(points, name)
    if array.ndim != 2 or array.shape[1] != 2 or len(array) not in SCHEMES[scheme]:
        wanted = " or ".join(f"({count}, 2)" for count in SCHEMES[scheme])
        raise ValueError(f"{name}: expected shape {wanted} px for scheme {scheme!r}, got {array.shape}")
    return landmark_array(_taken(array, scheme), name)


def _taken(points: _Floats, scheme: str) -> _Floats:
    first, second, share = _table(scheme)
    placed = np.where(first[:, None] >= 0, points[first], np.nan)
    between = np.flatnonzero(share)
    if len(between):
        a, b = points[first[between]], points[second[between]]
        lost = np.isinf(a) | np.isinf(b)  # stays infinite, to be refused
        placed[between] = np.where(lost, np.inf, (1 - share[between, None]) * a + share[between, None] * b)
    return placed


@cache
def _table(scheme: str) -> tuple[NDArray[np.int64], NDArray[np.int64], _Floats]:
    """Of each landmark: the scheme's point a, its point b, and t in a + t (b - a); a = -1 where it has none."""
    order = np.arange(68)
    if scheme in ("ibug51", "ibug49"):
        missing = (*range(_JAW), *(_INNER_MOUTH_CORNERS if scheme == "ibug49" else ()))
        held = ~np.isin(order, missing)
        order = np.where(held, np.cumsum(held) - 1, -1)
    elif scheme == "wholebody133":
        order = order + _BODY_AND_FEET
    elif scheme == "mediapipe478":
        order = np.array([int(row["vertex"]) for row in _rows("mediapipe478.csv")])
    elif scheme not in ("ibug68", "openpose70"):
        cells = [row[scheme].split() for row in _rows("landmark_schemes.csv")]
        share = np.array([float(Fraction(cell[2])) if len(cell) == 3 else 0.0 for cell in cells])
        return np.array([int(cell[0]) for cell in cells]), np.array([int(cell[:2][-1]) for cell in cells]), share
    return order, order, np.zeros(68)


def _rows(table: str) -> list[dict[str, str]]:
    with open(data_path(f"data_templates/{table}"), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def _misfit(points: _Floats, scheme: str) -> float:
    taken = _taken(points, scheme)
    usable = np.isfinite(taken).all(axis=1)
    if not usable.any() or not np.ptp(taken[usable], axis=0).any():
        return 1.0  # no face at all
    return frontal_pose(taken[usable], frontal_layout().points[usable])[1]
