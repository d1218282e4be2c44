"""Similarities between a picture and the upright crop of a face, as 2 x 3 matrices."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["applied", "box_matrix", "box_of", "composed", "inverse", "similarity_onto"]

Floats = NDArray[np.float64]


def applied(matrix: Floats, points: Floats) -> Floats:
    """Points (..., 2) mapped by a (2, 3) matrix.

    Examples
    --------
    >>> applied(np.array([[2.0, 0, 1], [0, 2.0, 0]]), np.array([[3.0, 4.0]]))
    array([[7., 8.]])
    """
    return points @ matrix[:, :2].T + matrix[:, 2]


def inverse(matrix: Floats) -> Floats:
    """The (2, 3) matrix that undoes another."""
    linear = np.linalg.inv(matrix[:, :2])
    return np.column_stack([linear, -linear @ matrix[:, 2]])


def composed(second: Floats, first: Floats) -> Floats:
    """The (2, 3) matrix that maps as `first`, then `second` do."""
    return np.column_stack([second[:, :2] @ first[:, :2], applied(second, first[:, 2])])


def similarity_onto(points: Floats, targets: Floats) -> Floats:
    """The similarity (2, 3) without reflection that brings `points` (k, 2) nearest to `targets` (k, 2).

    As complex numbers the best factor is ``sum(conj(p) t) / sum(|p|^2)`` about the means.
    """
    middle, aim = points.mean(axis=0), targets.mean(axis=0)
    p, t = points - middle, targets - aim
    spread = (p * p).sum()
    real, imaginary = (p * t).sum() / spread, (p[:, 0] * t[:, 1] - p[:, 1] * t[:, 0]).sum() / spread
    linear = np.array([[real, -imaginary], [imaginary, real]])
    return np.column_stack([linear, aim - linear @ middle])


def box_of(points: Floats) -> Floats:
    """(x, y, r): the middle of points (k, 2) and their root mean square distance from it."""
    middle = points.mean(axis=0)
    return np.append(middle, np.sqrt(((points - middle) ** 2).sum(axis=1).mean()))


def box_matrix(box: Floats, size: int, radius: float) -> Floats:
    """The upright similarity (2, 3) that brings a box (x, y, r) to the middle of a crop with the given radius."""
    scale = radius / box[2]
    return np.array([[scale, 0, size / 2 - scale * box[0]], [0, scale, size / 2 - scale * box[1]]])
