"""Pixels into a picture file."""

import os

from numpy.typing import ArrayLike

from toongeo.io.atomic_write import atomic_write
from toongeo.io.encode_image import encode_image
from toongeo.reading.check_file import file_name

__all__ = ["write_image"]


def write_image(path: str | os.PathLike[str], img: ArrayLike, *, quality: int = 92) -> None:
    """Write a picture; atomically.

    Parameters
    ----------
    path
        ``.png``, ``.jpg``, ``.jpeg`` or ``.webp``.
    img
        (H, W, 3) uint8 sRGB; (H, W, 4) with alpha (not for JPEG); or (H, W) grey.
    quality
        Of JPEG and WebP, 1 to 100.

    Raises
    ------
    ValueError
        If the suffix or the pixels are none of these.
    OSError
        If the path cannot be written; nothing half-written remains.
    """
    atomic_write({path: encode_image(img, file_name(path).suffix, quality=quality)})
