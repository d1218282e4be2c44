"""What every function that takes or gives 68 landmarks demands of the array."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.io.point_array import point_array

__all__ = ["landmark_array"]

# Landmark schemes in use, by their number of points: what people pass by mistake.
_SCHEMES = {
    5: "eye centres, nose and mouth corners",
    49: "the inner points without 60 and 64",
    51: "iBUG-68 without the jaw: put NaN in rows 0-16",
    98: "WFLW",
    106: "JD-landmark",
    468: "MediaPipe's face mesh",
    478: "MediaPipe's face mesh with irises",
}


def landmark_array(landmarks: ArrayLike, name: str = "landmarks") -> NDArray[np.float64]:
    """Checked copy: (68, 2) float64, finite or NaN in whole rows, at least one row not NaN."""
    points = point_array(landmarks, name, "68 rows of x and y")
    if points.ndim == 2 and points.shape[1] == 2 and len(points) != 68:
        hint = _SCHEMES.get(len(points))
        note = f" ({hint})" if hint else ""
        raise ValueError(f"{name}: expected 68 points in iBUG order, got {len(points)}{note}")
    if points.shape != (68, 2):
        raise ValueError(f"{name}: expected shape (68, 2), got {points.shape}")
    if np.isinf(points).any():
        raise ValueError(f"{name}: expected finite px or NaN, got infinity in row {_first(np.isinf(points))}")
    missing = np.isnan(points)
    if missing.all():
        raise ValueError(f"{name}: expected at least one point, but all rows are NaN")
    half = missing.any(axis=1) & ~missing.all(axis=1)
    if half.any():
        raise ValueError(f"{name}: a missing point has NaN in both coordinates; row {_first(half)} in one only")
    return points


def _first(mask: ArrayLike) -> int:
    return int(np.argwhere(mask)[0, 0])
