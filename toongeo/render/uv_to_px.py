"""Texture coordinates as pixels of the atlas."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["uv_to_px"]


def uv_to_px(uv: ArrayLike, height: int, width: int) -> NDArray[np.float64]:
    """Where texture coordinates lie in an atlas of ``height`` x ``width`` texels.

    UV has its origin at the bottom left and v up, so the texel (row i, column j) has its centre at
    u = (j + 0.5) / width, v = 1 - (i + 0.5) / height; integers are texel centres.

    Parameters
    ----------
    uv : array_like, shape (t, 2)
        Texture coordinates, [0, 1] inside the atlas.
    height, width : int
        Size of the atlas in texels.

    Returns
    -------
    ndarray, shape (t, 2)
        x right, y down, in texels.

    Raises
    ------
    ValueError
        If ``uv`` is not (t, 2).

    Examples
    --------
    >>> uv_to_px([[0.0, 1.0], [0.5, 0.5]], 4, 8)
    array([[-0.5, -0.5],
           [ 3.5,  1.5]])
    """
    coordinates = np.asarray(uv, dtype=np.float64)
    if coordinates.ndim != 2 or coordinates.shape[1] != 2:
        raise ValueError(f"uv: expected shape (t, 2), got {coordinates.shape}")
    return np.column_stack([coordinates[:, 0] * width, (1.0 - coordinates[:, 1]) * height]) - 0.5
