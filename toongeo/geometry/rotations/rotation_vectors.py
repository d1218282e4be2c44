"""Rotation vectors: the exponential map and its derivative."""

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["left_jacobian", "rotated", "rotation_matrix", "turn_of"]

_SMALL = 1e-3  # rad; below it the closed forms cancel and a Taylor polynomial is exact to 1e-16


def rotation_matrix(w: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (3, 3) by ``|w|`` radians about ``w`` (3,): ``exp([w]x)``, Rodrigues' formula.

    Examples
    --------
    >>> rotation_matrix(np.array([0.0, 0.0, np.pi / 2])).round(12) @ [1.0, 0.0, 0.0]
    array([0., 1., 0.])
    """
    a, b, _, square = _coefficients(w)
    return _combination(1 - b * square, a, b, w)


def left_jacobian(w: NDArray[np.float64]) -> NDArray[np.float64]:
    """Matrix J (3, 3) with ``exp([w + dw]x) = exp([J dw]x) exp([w]x)`` to first order in ``dw``.

    So a point ``y = exp([w]x) y0`` moves by ``(J dw) x y``.
    """
    _, b, c, square = _coefficients(w)
    return _combination(1 - c * square, b, c, w)


def rotated(w: NDArray[np.float64], v: NDArray[np.float64]) -> tuple[float, float, float]:
    """``rotation_matrix(w) @ v`` of one vector (3,), without the matrix.

    Examples
    --------
    >>> np.round(rotated(np.array([0.0, 0.0, np.pi / 2]), np.array([1.0, 0.0, 0.0])), 12)
    array([0., 1., 0.])
    """
    a, b, _, square = _coefficients(w)
    return _combined(1 - b * square, a, b, w.tolist(), v.tolist())


def turn_of(w: NDArray[np.float64], pull: tuple[float, float, float]) -> tuple[float, float, float]:
    """``left_jacobian(w).T @ pull``: the derivative by w of what has the derivative ``pull`` by a turn after w."""
    _, b, c, square = _coefficients(w)
    return _combined(1 - c * square, -b, c, w.tolist(), list(pull))


def _combined(i: float, a: float, b: float, w: list[float], v: list[float]) -> tuple[float, float, float]:
    """``i v + a w x v + b w (w . v)`` in plain numbers."""
    (x, y, z), (p, q, r) = w, v
    along = b * (x * p + y * q + z * r)
    return (
        i * p + a * (y * r - z * q) + along * x,
        i * q + a * (z * p - x * r) + along * y,
        i * r + a * (x * q - y * p) + along * z,
    )


def _coefficients(w: NDArray[np.float64]) -> tuple[float, float, float, float]:
    """``sin t / t``, ``(1 - cos t) / t^2``, ``(t - sin t) / t^3`` and ``t^2`` for ``t = |w|``."""
    square = float(w @ w)
    t = math.sqrt(square)
    if t < _SMALL:
        return (
            1 - square / 6 + square**2 / 120,
            1 / 2 - square / 24 + square**2 / 720,
            1 / 6 - square / 120 + square**2 / 5040,
            square,
        )
    return math.sin(t) / t, (1 - math.cos(t)) / square, (t - math.sin(t)) / (square * t), square


def _combination(i: float, a: float, b: float, w: NDArray[np.float64]) -> NDArray[np.float64]:
    """``i I + a [w]x + b w w^T``, element by element: these small products are called most often of all.

    With ``[w]x^2 = w w^T - t^2 I`` both matrices above have this form.
    """
    x, y, z = w.tolist()
    bx, by, bz = b * x, b * y, b * z
    return np.array(
        [
            [i + bx * x, bx * y - a * z, bx * z + a * y],
            [bx * y + a * z, i + by * y, by * z - a * x],
            [bx * z - a * y, by * z + a * x, i + bz * z],
        ]
    )
