"""Landmark error of each part of the face."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["IBUG68_PARTS", "OUTER_EYES", "landmark_error"]

# The iBUG-68 scheme, 0-based.
IBUG68_PARTS: Mapping[str, range] = MappingProxyType(
    {
        "jaw": range(0, 17),  # contour, from the subject's right ear over the chin to the left
        "brow": range(17, 27),  # right, then left
        "nose": range(27, 36),  # bridge, then base
        "eyes": range(36, 48),  # right, then left, each from its corner on the subject's right
        "mouth": range(48, 68),  # outer, then inner lip line
        "inner51": range(17, 68),  # all but the contour
        "total": range(0, 68),
    }
)
OUTER_EYES = (36, 45)  # outer corner of the right eye, of the left eye


def landmark_error(
    predicted: ArrayLike,
    truth: ArrayLike,
    *,
    parts: Mapping[str, ArrayLike | range] = IBUG68_PARTS,
    scale: float | None = None,
) -> dict[str, float]:
    """Root mean square landmark distance of each part, as a fraction of the outer-eye distance.

    Parameters
    ----------
    predicted, truth : (k, 2) or (k, 3) float
        Landmarks in one frame and unit. A row with a NaN, in either, is missing and left out.
    parts
        Name -> landmark indices. Default: jaw, brow, nose, eyes, mouth, inner51 and total of iBUG-68.
    scale
        Divisor. Default: the distance of the outer eye corners (points 36 and 45) of `truth`.

    Returns
    -------
    dict of str to float
        0.01 is one per cent of the scale. NaN for a part of which every landmark is missing.

    Raises
    ------
    ValueError
        If shapes differ or are wrong, an index is out of range, or the scale is missing, zero or not finite.

    Examples
    --------
    >>> import numpy as np
    >>> truth = np.zeros((68, 2))
    >>> truth[45, 0] = 100
    >>> landmark_error(truth + [3, 4], truth)["nose"]
    0.05
    """
    found, true = _checked("predicted", predicted), _checked("truth", truth)
    if found.shape != true.shape:
        raise ValueError(f"predicted: expected shape {true.shape} as truth has, got {found.shape}")
    chosen = {name: np.asarray(part, dtype=np.int64) for name, part in parts.items()}
    for name, part in chosen.items():
        if part.size and (part.min() < 0 or part.max() >= len(true)):
            raise ValueError(f"parts[{name!r}]: expected indices below {len(true)}, got up to {part.max()}")
    if scale is None:
        scale = _outer_eye_distance(true)
    if not (np.isfinite(scale) and scale > 0):
        raise ValueError(f"scale: expected a finite number above 0, got {scale}")

    squared = ((found - true) ** 2).sum(axis=1)
    errors = {}
    for name, part in chosen.items():
        known = squared[part][np.isfinite(squared[part])]
        errors[name] = float(np.sqrt(known.mean()) / scale) if len(known) else float("nan")
    return errors


def _checked(name: str, values: ArrayLike) -> NDArray[np.float64]:
    points = np.asarray(values, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise ValueError(f"{name}: expected shape (k, 2) or (k, 3), got {points.shape}")
    if np.isinf(points).any():
        raise ValueError(f"{name}: expected finite values or NaN, got infinity")
    return points


def _outer_eye_distance(truth: NDArray[np.float64]) -> float:
    if len(truth) <= max(OUTER_EYES):
        raise ValueError(f"truth: expected the 68 points of iBUG or a `scale`, got {len(truth)} points")
    right, left = truth[list(OUTER_EYES)]
    distance = float(np.linalg.norm(left - right))
    if not distance > 0:
        raise ValueError(
            f"truth: expected two different outer eye corners (points {OUTER_EYES}) or a `scale`, "
            f"got {right.tolist()} and {left.tolist()}"
        )
    return distance
