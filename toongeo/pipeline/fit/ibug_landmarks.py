"""Landmark schemes that give points of iBUG-68."""

from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.io.landmark_array import landmark_array
from toongeo.io.point_array import point_array
from toongeo.model.ibug68 import INNER, LIP_RIMS
from toongeo.model.mediapipe478 import N_MESH, N_WITH_IRISES, VERTICES

__all__ = ["PARTS_OF_IBUG", "SCHEMES", "ibug_landmarks"]

_INNER_CORNERS = [LIP_RIMS["lip_upper_inner"][0], LIP_RIMS["lip_upper_inner"][-1]]

# Name -> where its points stand in iBUG-68. The 49 points are the inner ones without the inner mouth corners.
PARTS_OF_IBUG = MappingProxyType(
    {"ibug68": np.arange(68), "ibug51": INNER, "ibug49": INNER[~np.isin(INNER, _INNER_CORNERS)]}
)
SCHEMES = (*PARTS_OF_IBUG, "mediapipe478")


def ibug_landmarks(landmarks: ArrayLike, scheme: str = "ibug68") -> NDArray[np.float64]:
    """The 68 landmarks (68, 2) px out of those of a scheme; what it does not have is NaN.

    Every function with ``scheme=`` takes its landmarks through this door, and knows 68 points behind it.

    Parameters
    ----------
    landmarks : array_like, px
        (68, 2), (51, 2) or (49, 2) for parts of iBUG-68; (478, 2) or (468, 2) for MediaPipe's face mesh, in pixels: its
        coordinates are shares of the picture's width and height.
    scheme : {"ibug68", "ibug51", "ibug49", "mediapipe478"}
        All points; without the jaw (0-16); without the inner mouth corners (60, 64) either; and the face mesh,
        of which `toongeo.model.mediapipe478` takes 68 points.

    Raises
    ------
    ValueError
        If the scheme is not known, its number of points is another, they are not numbers, one is infinite or half
        missing, or all are missing.

    Examples
    --------
    >>> import numpy as np
    >>> np.flatnonzero(np.isnan(ibug_landmarks(np.zeros((49, 2)), "ibug49")[:, 0]))
    array([ 0,  1,  2,  3,  4,  5,  6,  7,  8,  9, 10, 11, 12, 13, 14, 15, 16,
           60, 64])
    >>> ibug_landmarks(np.arange(956.0).reshape(478, 2), "mediapipe478")[36]  # point 33 of the mesh
    array([66., 67.])
    """
    if not isinstance(scheme, str):
        raise ValueError(
            f"scheme: expected a name here, got {type(scheme).__name__}: a table is for fit_3dmm and make_avatar"
        )
    if scheme not in SCHEMES:
        raise ValueError(f"scheme: expected one of {', '.join(map(repr, SCHEMES))}, or a table, got {scheme!r}")
    if scheme == "ibug68":
        return landmark_array(landmarks)  # says more about another shape
    points = point_array(landmarks)
    if scheme == "mediapipe478":
        if points.shape not in ((N_WITH_IRISES, 2), (N_MESH, 2)):
            wanted = f"({N_WITH_IRISES}, 2) or ({N_MESH}, 2)"
            raise ValueError(f"landmarks: expected shape {wanted} px for scheme {scheme!r}, got {points.shape}")
        return landmark_array(points[VERTICES])
    where = PARTS_OF_IBUG[scheme]
    if points.shape != (len(where), 2):
        raise ValueError(f"landmarks: expected shape ({len(where)}, 2) for scheme {scheme!r}, got {points.shape}")
    placed = np.full((68, 2), np.nan)
    placed[where] = points
    return landmark_array(placed)
