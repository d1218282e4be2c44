"""How far the colours of a rendering are from those of its picture."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["photometric_error"]


def photometric_error(rendered: ArrayLike, picture: ArrayLike, mask: ArrayLike) -> float:
    """Mean Manhattan distance of two pictures' colours inside a mask (Pan et al. 2024, section 4.2.1).

    Parameters
    ----------
    rendered, picture : (H, W, 3) uint8 RGB
    mask : (H, W) bool
        Where to look.

    Returns
    -------
    float
        Mean over the pixels of ``|dr| + |dg| + |db|``, each in levels of 0..255, hence from 0 to 765. (The paper names
        no unit; its 3.31 is more than colours in 0..1 can differ.)

    Raises
    ------
    ValueError
        If a picture is not (H, W, 3) uint8, the sizes differ, or the mask is not bool or empty.

    Examples
    --------
    >>> import numpy as np
    >>> picture = np.full((4, 4, 3), 100, np.uint8)
    >>> photometric_error(picture + np.array([1, 2, 3], np.uint8), picture, np.ones((4, 4), bool))
    6.0
    """
    first, second = _pixels("rendered", rendered), _pixels("picture", picture)
    if first.shape != second.shape:
        raise ValueError(f"rendered: expected shape {second.shape} as picture has, got {first.shape}")
    inside = np.asarray(mask)
    if inside.dtype != bool or inside.shape != second.shape[:2]:
        raise ValueError(f"mask: expected bool {second.shape[:2]}, got {inside.dtype} {inside.shape}")
    if not inside.any():
        raise ValueError("mask: expected at least one pixel, got none")
    difference = np.abs(first[inside].astype(np.int64) - second[inside])
    return float(difference.sum() / inside.sum())


def _pixels(name: str, values: ArrayLike) -> NDArray[np.uint8]:
    pixels = np.asarray(values)
    if pixels.dtype != np.uint8 or pixels.ndim != 3 or pixels.shape[2] != 3:
        raise ValueError(f"{name}: expected uint8 (H, W, 3), got {pixels.dtype} {pixels.shape}")
    return pixels
