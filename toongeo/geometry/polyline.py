"""Polylines: lengths along them, and values between their points."""

import numpy as np

from toongeo.arrays import Floats

__all__ = ["arc_length", "arc_shares", "interpolated"]

_NO_LENGTH = 1e-12  # a path that is shorter has no shares; those of its points are 0


def arc_length(path: Floats, least: float = 0.0) -> Floats:
    """Length along a path of points (k, d) up to each, (k,), in the unit of the points.

    ``least`` is added to every segment, so that points that coincide still follow each other.

    Examples
    --------
    >>> arc_length(np.array([[0.0, 0], [3, 4], [3, 5]]))
    array([0., 5., 6.])
    """
    return np.r_[0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1) + least)]


def arc_shares(path: Floats) -> Floats:
    """The same as a share of the whole length, (k,) in [0, 1].

    Examples
    --------
    >>> arc_shares(np.array([[0.0, 0], [3, 0], [3, 1]]))
    array([0.  , 0.75, 1.  ])
    """
    length = arc_length(path)
    return np.asarray(length / max(length[-1], _NO_LENGTH))


def interpolated(at: Floats, known: Floats, values: Floats) -> Floats:
    """Rows (k, d) at places (k,) of a path, linearly between values (m, d) that are given at others (m,), ascending.

    Examples
    --------
    >>> interpolated(np.array([0.5]), np.array([0.0, 1.0]), np.array([[0.0, 10], [2, 20]]))
    array([[ 1., 15.]])
    """
    return np.column_stack([np.interp(at, known, column) for column in values.T])
