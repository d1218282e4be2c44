"""Landmark error of each part of the face in pixels of a crop of fixed size."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.metrics.landmark_error import IBUG68_PARTS

__all__ = ["CROP_PX", "TABLE_PARTS", "face_square", "landmark_distance"]

CROP_PX = 224  # side of the crops of Pan et al. 2024
MARGIN = 1.7  # side of the crop / greater side of the landmarks' bounding box
RAISED = 0.12  # of the side: the landmarks leave out the forehead
# The columns of Pan et al.'s Table 1.
TABLE_PARTS: Mapping[str, range] = MappingProxyType(
    {
        **{part: IBUG68_PARTS[part] for part in ("eyes", "nose", "brow", "mouth")},
        "contour": IBUG68_PARTS["jaw"],
        "total": IBUG68_PARTS["total"],
    }
)


def landmark_distance(predicted: ArrayLike, truth: ArrayLike) -> dict[str, float]:
    """Mean Euclidean landmark distance by part, px of a 224 x 224 crop of the face (Pan et al. 2024, section 4.2.1).

    Parameters
    ----------
    predicted, truth : (68, 2) float, px
        A row with a NaN, in either, is missing and left out.

    Returns
    -------
    dict of str to float
        eyes, nose, brow, mouth, contour, and total, the mean over all points. NaN for a part of which every point is
        missing.

    Raises
    ------
    ValueError
        If a shape is wrong, a value infinite, or the points of ``truth`` coincide or are all missing.

    Examples
    --------
    >>> import numpy as np
    >>> truth = np.zeros((68, 2))
    >>> truth[0] = 224 / 1.7, 0  # so that the crop has the resolution of the picture
    >>> round(landmark_distance(truth + [3, 4], truth)["nose"], 9)
    5.0
    """
    found, true = _points("predicted", predicted), _points("truth", truth)
    distance = np.linalg.norm(found - true, axis=1) * (CROP_PX / face_square(true)[1])
    means = {}
    for part, points in TABLE_PARTS.items():
        known = distance[points][np.isfinite(distance[points])]
        means[part] = float(known.mean()) if len(known) else float("nan")
    return means


def face_square(landmarks: ArrayLike) -> tuple[NDArray[np.float64], float]:
    """Upper left corner (2,) and side, px, of the square around a face that is the crop.

    Parameters
    ----------
    landmarks : (68, 2) float, px
        NaN rows are missing.

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
    points = _points("landmarks", landmarks)
    points = points[np.isfinite(points).all(axis=1)]
    extent = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    if not extent > 0:
        raise ValueError("landmarks: expected points that span a face, got them all missing or in one place")
    side = MARGIN * extent
    return (points.min(axis=0) + points.max(axis=0)) / 2 - side / 2 - [0.0, RAISED * side], side


def _points(name: str, values: ArrayLike) -> NDArray[np.float64]:
    points = np.asarray(values, np.float64)
    if points.shape != (68, 2) or np.isinf(points).any():
        raise ValueError(f"{name}: expected finite or NaN values of shape (68, 2), got shape {points.shape}")
    return points
