"""Rotation matrices from rotation vectors, many at once."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats

__all__ = ["cross_matrix", "right_jacobian", "rotation_exp"]

_SMALL = 1e-2  # rad; below it the closed forms cancel, and four terms of the series are exact to 1e-16


def rotation_exp(w: Floats) -> Floats:
    """Rotations (3, 3, n) by ``|w|`` radians about the vectors ``w`` (3, n): ``exp([w]x)``.

    Parameters
    ----------
    w : (3, n) float, radians

    Returns
    -------
    (3, 3, n) float64
        Matrix ``[:, :, i]`` belongs to the vector ``[:, i]``.

    Examples
    --------
    >>> rotation_exp(np.array([[0.0], [0.0], [np.pi / 2]]))[:, :, 0].round(12) + 0.0
    array([[ 0., -1.,  0.],
           [ 1.,  0.,  0.],
           [ 0.,  0.,  1.]])
    """
    a, b, _, square = _coefficients(w)
    R = a * cross_matrix(w) + b * w[:, None] * w
    R[[0, 1, 2], [0, 1, 2]] += 1 - b * square
    return R


def right_jacobian(w: Floats) -> Floats:
    """Matrices J (3, 3, n) with ``exp([w + dw]x) = exp([w]x) exp([J dw]x)`` to first order in ``dw``."""
    _, b, c, square = _coefficients(w)
    J = -b * cross_matrix(w) + c * w[:, None] * w
    J[[0, 1, 2], [0, 1, 2]] += 1 - c * square
    return J


def cross_matrix(w: Floats) -> Floats:
    """``[w]x`` (3, 3, n) with ``[w]x v = w x v`` of vectors (3, n)."""
    K = np.zeros((3, *w.shape))
    K[2, 1], K[0, 2], K[1, 0] = w
    K[1, 2], K[2, 0], K[0, 1] = -w
    return K


def _coefficients(w: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """``sin t / t``, ``(1 - cos t) / t^2``, ``(t - sin t) / t^3`` and ``t^2`` for ``t = |w|``."""
    square = (w * w).sum(axis=0)
    t = np.sqrt(square)
    small = t < _SMALL
    far = np.where(small, 1.0, t)
    sine = np.sin(far) / far
    a = np.where(small, 1 - square / 6 * (1 - square / 20 * (1 - square / 42)), sine)
    b = np.where(small, 0.5 - square / 24 * (1 - square / 30 * (1 - square / 56)), (1 - np.cos(far)) / far**2)
    c = np.where(small, 1 / 6 - square / 120 * (1 - square / 42 * (1 - square / 72)), (1 - sine) / far**2)
    return a, b, c, square
