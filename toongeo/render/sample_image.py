"""Bilinear sampling of an image."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["sample_image"]

_CHUNK = 2**15  # samples that stay in the cache


def sample_image(img: ArrayLike, px: ArrayLike) -> NDArray[Any]:
    """Values of an image between its pixels, by bilinear interpolation.

    Outside, the nearest pixel of the border counts.

    Parameters
    ----------
    img : array_like, shape (height, width) or (height, width, c)
        Any numeric type.
    px : array_like, shape (k, 2)
        x (right) and y (down) in pixels; integers are pixel centres.

    Returns
    -------
    ndarray, shape (k,) or (k, c)
        In the units of the image (0..255 for uint8); float64 if ``img`` is float64 or has 32-bit integers,
        else float32.

    Raises
    ------
    ValueError
        If ``img`` is empty or not 2-D or 3-D, or ``px`` is not (k, 2) or not finite.

    Examples
    --------
    >>> sample_image([[0.0, 10.0], [20.0, 30.0]], [[0.0, 0.0], [0.5, 0.5], [9.0, -9.0]])
    array([ 0., 15., 10.])
    """
    image, points = np.asarray(img), np.asarray(px, dtype=np.float64)
    if image.ndim not in (2, 3) or image.size == 0:
        raise ValueError(f"img: expected shape (height, width) or (height, width, c), got {image.shape}")
    if points.ndim != 2 or points.shape[1] != 2:
        raise ValueError(f"px: expected shape (k, 2), got {points.shape}")
    if not np.isfinite(points).all():
        raise ValueError("px: expected finite coordinates, got NaN or infinity")
    height, width = image.shape[:2]
    texels = image.reshape(height * width, -1)
    values = np.empty((len(points), texels.shape[1]), np.result_type(image.dtype, np.float32))
    for start in range(0, len(points), _CHUNK):
        rows = slice(start, start + _CHUNK)
        values[rows] = _bilinear(texels, points[rows], height, width, values.dtype)
    return values.reshape(len(points), *image.shape[2:])


def _bilinear(
    texels: NDArray[Any], points: NDArray[np.float64], height: int, width: int, dtype: np.dtype[Any]
) -> NDArray[Any]:
    x = np.clip(points[:, 0], 0.0, width - 1.0)
    y = np.clip(points[:, 1], 0.0, height - 1.0)
    column, row = x.astype(np.intp), y.astype(np.intp)
    right, down = np.minimum(column + 1, width - 1), np.minimum(row + 1, height - 1)
    fx, fy = (x - column).astype(dtype)[:, None], (y - row).astype(dtype)[:, None]
    row *= width
    down *= width
    upper = texels.take(row + column, axis=0) * (1 - fx) + texels.take(row + right, axis=0) * fx
    lower = texels.take(down + column, axis=0) * (1 - fx) + texels.take(down + right, axis=0) * fx
    return upper * (1 - fy) + lower * fy
