"""Missing landmarks of a curve from their neighbours on it.

Constants were chosen on every third landmark of 25 pictures (``benchmarks/alignment.py``).
"""

import numpy as np

from toongeo.arrays import Floats
from toongeo.model.ibug68 import PARTS

__all__ = ["curve_points", "with_curve_points"]

# Open curves along which annotators space their points evenly. Rims of eyes and lips turn sharply at their corners:
# what the motion of the face foretells is nearer there.
_CURVES = (PARTS["jaw"], PARTS["brow_right"], PARTS["brow_left"], PARTS["nose"][:4], PARTS["nose"][4:])
_SHARE = 0.5  # of the curve, against the motion: their errors are alike and hardly related
_JAW_SHARE = 1.0  # how far along the jaw a point lies is a matter of spacing alone


def with_curve_points(landmarks: Floats, foretold: Floats) -> Floats:
    """Landmarks (68, 2) px in which points of open curves are filled in, where both of their neighbours are there.

    Parameters
    ----------
    landmarks : (68, 2) float, px
        NaN rows are missing; the others come back as they are.
    foretold : (68, 2) float, px
        Where the motion of the face takes them.
    """
    missing = np.asarray(~np.isfinite(landmarks).all(axis=1))
    if not missing.any():
        return landmarks
    found = curve_points(landmarks)
    share = np.full((68, 1), _SHARE)
    share[PARTS["jaw"]] = _JAW_SHARE
    filled = np.where(missing[:, None], share * found + (1 - share) * foretold, landmarks)
    return np.asarray(filled, np.float64)


def curve_points(landmarks: Floats) -> Floats:
    """Each point (68, 2) of an open curve as its four nearest neighbours have it, or three; NaN for all others.

    By the polynomial through the points before and after it and those beyond them, in their order along the curve
    (Lagrange). Of two neighbours alone nothing is made: the middle between them lies inside of a bow.

    Examples
    --------
    >>> bow = np.column_stack([np.arange(68.0), np.arange(68.0) ** 2])
    >>> curve_points(bow)[[5, 20, 1, 0]]
    array([[  5.,  25.],
           [ 20., 400.],
           [  1.,   1.],
           [ nan,  nan]])
    """
    found = np.full((68, 2), np.nan)
    for curve in _CURVES:
        points = landmarks[list(curve)]
        there = np.asarray(np.isfinite(points).all(axis=1))
        for k in range(1, len(points) - 1):
            near = [j for j in (k - 2, k - 1, k + 1, k + 2) if 0 <= j < len(points) and there[j]]
            if len(near) >= 3 and there[k - 1] and there[k + 1]:
                found[curve[k]] = _lagrange(np.array(near) - k) @ points[near]
    return found


def _lagrange(at: np.ndarray) -> Floats:
    """Weights (c,) of values at integers (c,) in the value at 0 of the polynomial through them."""
    return np.array([np.prod([-other / (own - other) for other in at if other != own]) for own in at])
