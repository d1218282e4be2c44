"""Rotation vectors: the exponential map and its derivative."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["left_jacobian", "rotation_matrix"]

_SMALL = 1e-3  # rad; below it the closed forms cancel and a Taylor polynomial is exact to 1e-16


def rotation_matrix(w: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (3, 3) by ``|w|`` radians about ``w`` (3,): ``exp([w]x)``, Rodrigues' formula.

    Examples
    --------
    >>> rotation_matrix(np.array([0.0, 0.0, np.pi / 2])).round(12) @ [1.0, 0.0, 0.0]
    array([0., 1., 0.])
    """
    a, b, _ = _coefficients(w)
    W = _cross_matrix(w)
    return np.eye(3) + a * W + b * (W @ W)


def left_jacobian(w: NDArray[np.float64]) -> NDArray[np.float64]:
    """Matrix J (3, 3) with ``exp([w + dw]x) = exp([J dw]x) exp([w]x)`` to first order in ``dw``.

    So a point ``y = exp([w]x) y0`` moves by ``(J dw) x y``.
    """
    _, b, c = _coefficients(w)
    W = _cross_matrix(w)
    return np.eye(3) + b * W + c * (W @ W)


def _coefficients(w: NDArray[np.float64]) -> tuple[float, float, float]:
    """``sin t / t``, ``(1 - cos t) / t^2`` and ``(t - sin t) / t^3`` for ``t = |w|``."""
    square = float(w @ w)
    t = np.sqrt(square)
    if t < _SMALL:
        return (
            1 - square / 6 + square**2 / 120,
            1 / 2 - square / 24 + square**2 / 720,
            1 / 6 - square / 120 + square**2 / 5040,
        )
    return float(np.sin(t) / t), float((1 - np.cos(t)) / square), float((t - np.sin(t)) / (square * t))


def _cross_matrix(w: NDArray[np.float64]) -> NDArray[np.float64]:
    x, y, z = w
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
