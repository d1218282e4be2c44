"""Landmark error of each part of the face in pixels of a crop of fixed size."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.metrics.face_square import face_square
from toongeo.metrics.landmark_error import IBUG68_PARTS

__all__ = ["CROP_PX", "TABLE_PARTS", "landmark_distance"]

CROP_PX = 224  # side of the crops of Pan et al. 2024
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


def _points(name: str, values: ArrayLike) -> NDArray[np.float64]:
    points = np.asarray(values, np.float64)
    if points.shape != (68, 2) or np.isinf(points).any():
        raise ValueError(f"{name}: expected finite or NaN values of shape (68, 2), got shape {points.shape}")
    return points
