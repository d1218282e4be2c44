"""The square around a face in which errors are measured."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["face_square"]

_MARGIN = 1.7  # side of the square / greater side of the landmarks' bounding box
_RAISED = 0.12  # of the side: the landmarks leave out the forehead


def face_square(landmarks: ArrayLike) -> tuple[NDArray[np.float64], float]:
    """Upper left corner (2,) and side, px, of the square around a face that is the crop.

    Parameters
    ----------
    landmarks : (68, 2) float, px
        NaN rows are missing.

    Returns
    -------
    corner : (2,) float64, px
    side : float, px

    Raises
    ------
    ValueError
        If the shape is wrong, a value infinite, or the points coincide or are all missing.

    Examples
    --------
    >>> import numpy as np
    >>> points = np.zeros((68, 2))
    >>> points[1:] = 100, 80
    >>> corner, side = face_square(points)
    >>> corner.round(6), side
    (array([-35. , -65.4]), 170.0)
    """
    points = np.asarray(landmarks, np.float64)
    if points.shape != (68, 2) or np.isinf(points).any():
        raise ValueError(f"landmarks: expected finite or NaN values of shape (68, 2), got shape {points.shape}")
    points = points[np.isfinite(points).all(axis=1)]
    extent = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    if not extent > 0:
        raise ValueError("landmarks: expected points that span a face, got them all missing or in one place")
    side = _MARGIN * extent
    return (points.min(axis=0) + points.max(axis=0)) / 2 - side / 2 - [0.0, _RAISED * side], side
