"""A hair mask that was made elsewhere: by hand, or by another program."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.io import read_image
from toongeo.protocols import HairMask

__all__ = ["given_hair"]

_HALF = 127  # levels 0-255 above this are hair


def given_hair(mask: ArrayLike | str | os.PathLike[str], shape: tuple[int, ...]) -> HairMask:
    """A trusted hair mask from an array or a file.

    Parameters
    ----------
    mask : array_like or path
        (H, W) bool, or numbers 0..255 of which those above 127 are hair; or a grey picture of such numbers, white
        where there is hair.
    shape : tuple of int
        Of the picture, (H, W) or (H, W, 3).

    Raises
    ------
    ValueError
        If it has another size than the picture, other values, no hair at all or nothing but hair, or the file is no
        picture.
    OSError
        If the file is missing.

    Examples
    --------
    >>> drawn = np.zeros((40, 30), bool)
    >>> drawn[5:15, 5:25] = True
    >>> given_hair(drawn, (40, 30, 3)).trusted
    True
    """
    array = _read(mask) if isinstance(mask, str | os.PathLike) else np.asarray(mask)
    if array.shape != tuple(shape[:2]):
        raise ValueError(f"hair_mask: expected the picture's size {tuple(shape[:2])}, got shape {array.shape}")
    if array.dtype != np.bool_:
        if not np.issubdtype(array.dtype, np.number) or not ((array >= 0) & (array <= 255)).all():
            raise ValueError(f"hair_mask: expected bool or numbers 0..255, got others in {array.dtype}")
        array = array > _HALF
    if not array.any():
        raise ValueError("hair_mask: expected some hair, got an empty mask (for none, ask for no hair)")
    if array.all():
        raise ValueError("hair_mask: expected hair and other things, got a mask that covers the whole picture")
    return HairMask(array, trusted=True)


def _read(path: str | os.PathLike[str]) -> NDArray[np.uint8]:
    return np.asarray(read_image(path).max(axis=2), np.uint8)
