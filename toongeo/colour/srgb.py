"""The transfer function of sRGB and its inverse (IEC 61966-2-1)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["linear_slope", "linear_to_srgb", "srgb_to_linear"]

# The standard's rounded thresholds, 0.04045 and 0.0031308, leave a step of 1e-8 between the two branches.
_ENCODED_THRESHOLD, _LINEAR_THRESHOLD = 0.04045, 0.0031308


def srgb_to_linear(srgb: ArrayLike) -> NDArray[Any]:
    """Linear light of sRGB values.

    Parameters
    ----------
    srgb : array_like, any shape
        0..1 as floats, or uint8, which stands for 0..255.

    Returns
    -------
    ndarray, same shape
        0..1; float32 for uint8 and float32, else float64. Values outside 0..1 are extended, not clipped.

    Examples
    --------
    >>> srgb_to_linear([0.0, 0.5, 1.0]).round(4)
    array([0.   , 0.214, 1.   ])
    >>> srgb_to_linear(np.array([255], np.uint8))
    array([1.], dtype=float32)
    """
    values = np.asarray(srgb)
    if values.dtype == np.uint8:
        return _decode(np.arange(256) / 255.0).astype(np.float32).take(values)
    return _decode(_floating(values))


def linear_to_srgb(linear: ArrayLike) -> NDArray[Any]:
    """sRGB values 0..1 of linear light 0..1; the inverse of `srgb_to_linear`.

    Parameters
    ----------
    linear : array_like, any shape
        0..1.

    Returns
    -------
    ndarray, same shape
        0..1; float32 for float32, else float64. Values outside 0..1 are extended, not clipped.

    Examples
    --------
    >>> linear_to_srgb([0.0, 0.214041, 1.0]).round(4)
    array([0. , 0.5, 1. ])
    """
    values = _floating(np.asarray(linear))
    curved = 1.055 * np.maximum(values, _LINEAR_THRESHOLD) ** (1.0 / 2.4) - 0.055
    return np.where(values <= _LINEAR_THRESHOLD, values * 12.92, curved)


def linear_slope(srgb: NDArray[Any]) -> NDArray[Any]:
    """Derivative of `srgb_to_linear` at floats of any shape.

    Examples
    --------
    >>> linear_slope(np.array([0.0, 1.0])).round(4)
    array([0.0774, 2.2749])
    """
    curved = 2.4 / 1.055 * ((np.maximum(srgb, _ENCODED_THRESHOLD) + 0.055) / 1.055) ** 1.4
    return np.where(srgb <= _ENCODED_THRESHOLD, 1 / 12.92, curved)


def _decode(values: NDArray[Any]) -> NDArray[Any]:
    curved = ((np.maximum(values, _ENCODED_THRESHOLD) + 0.055) / 1.055) ** 2.4
    return np.where(values <= _ENCODED_THRESHOLD, values / 12.92, curved)


def _floating(values: NDArray[Any]) -> NDArray[Any]:
    return values if values.dtype in (np.float32, np.float64) else values.astype(np.float64)
