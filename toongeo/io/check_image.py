"""What every function that takes a picture demands of it."""

import os

import numpy as np
from PIL import Image

__all__ = ["check_image"]


def check_image(img: object, name: str = "img") -> None:
    """Refuse what is not a picture as :func:`toongeo.read_image` gives it.

    Parameters
    ----------
    img
        Should be (H, W, 3) uint8 RGB with H, W >= 1.
    name : str
        What the caller calls it, for the message.

    Raises
    ------
    ValueError
        If it is anything else.

    Examples
    --------
    >>> check_image(np.zeros((2, 3, 3), np.uint8))
    >>> check_image(np.zeros((2, 3, 3)))
    Traceback (most recent call last):
    ValueError: img: expected (H, W, 3) uint8 RGB, got float64 of shape (2, 3, 3)
    """
    if isinstance(img, np.ndarray) and img.dtype == np.uint8 and img.ndim == 3 and img.shape[2] == 3 and img.size:
        return
    if isinstance(img, (str, os.PathLike)):
        got = f"a path: read_image({os.fspath(img)!r}) reads it"
    elif isinstance(img, Image.Image):
        got = f"a picture of Pillow: np.asarray({name}.convert('RGB')) is its array"
    else:
        array = np.asarray(img)
        kind = "" if isinstance(img, np.ndarray) else f"{type(img).__name__} of "
        got = f"{kind}{array.dtype} of shape {array.shape}"
    raise ValueError(f"{name}: expected (H, W, 3) uint8 RGB, got {got}")
