"""Landmark schemes that give points of iBUG-68."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.io import SCHEMES, ibug_points

__all__ = ["ibug_landmarks"]


def ibug_landmarks(landmarks: ArrayLike, scheme: str = "ibug68") -> NDArray[np.float64]:
    """The 68 landmarks (68, 2) px out of those of a scheme; what it does not have is NaN.

    Every function with ``scheme=`` takes its landmarks through this door, and knows 68 points behind it.

    Parameters
    ----------
    landmarks : array_like, px
        (k, 2), k as many points as the scheme has, all in pixels (MediaPipe's coordinates are shares of the picture's
        width and height: :func:`toongeo.read_landmarks` turns them into pixels).
    scheme : str
        ``"ibug68"``: all points; ``"ibug51"``: without the jaw (0-16); ``"ibug49"``: without the inner mouth corners
        (60, 64) either; ``"openpose70"``, ``"wflw98"``, ``"lapa106"``, ``"sensetime106"``, ``"insightface106"``,
        ``"wholebody133"``, and ``"mediapipe478"`` (or 468), of which tables in ``data_templates/`` take 68 points.

    Returns
    -------
    (68, 2) float64, px
        iBUG-68 order; rows that the scheme does not tell are NaN.

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
    return ibug_points(landmarks, scheme)
