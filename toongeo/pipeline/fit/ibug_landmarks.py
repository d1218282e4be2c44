"""Landmark schemes that are parts of iBUG-68."""

from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.model.ibug68 import INNER, LIP_RIMS

__all__ = ["SCHEMES", "ibug_landmarks"]

_INNER_CORNERS = [LIP_RIMS["lip_upper_inner"][0], LIP_RIMS["lip_upper_inner"][-1]]

# Name -> where its points stand in iBUG-68. The 49 points are the inner ones without the inner mouth corners.
SCHEMES = MappingProxyType({"ibug68": np.arange(68), "ibug51": INNER, "ibug49": INNER[~np.isin(INNER, _INNER_CORNERS)]})


def ibug_landmarks(landmarks: ArrayLike, scheme: str = "ibug68") -> NDArray[np.float64]:
    """The 68 landmarks (68, 2) px of a scheme that names some of them; the others are NaN.

    Parameters
    ----------
    landmarks : (68, 2), (51, 2) or (49, 2) array_like, px
    scheme : {"ibug68", "ibug51", "ibug49"}
        All points; without the jaw (0-16); and without the inner mouth corners (60, 64) either.

    Raises
    ------
    ValueError
        If the scheme is not known or its number of points is another.

    Examples
    --------
    >>> import numpy as np
    >>> np.flatnonzero(np.isnan(ibug_landmarks(np.zeros((49, 2)), "ibug49")[:, 0]))
    array([ 0,  1,  2,  3,  4,  5,  6,  7,  8,  9, 10, 11, 12, 13, 14, 15, 16,
           60, 64])
    """
    if scheme not in SCHEMES:
        raise ValueError(f"scheme: expected one of {', '.join(map(repr, SCHEMES))}, or a table, got {scheme!r}")
    if scheme == "ibug68":
        return np.array(landmarks, np.float64)  # its own checks say more about another shape
    where, points = SCHEMES[scheme], np.asarray(landmarks, np.float64)
    if points.shape != (len(where), 2):
        raise ValueError(f"landmarks: expected shape ({len(where)}, 2) for scheme {scheme!r}, got {points.shape}")
    placed = np.full((68, 2), np.nan)
    placed[where] = points
    return placed
