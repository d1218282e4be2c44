"""What every function that takes a picture demands of it."""

import numpy as np

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
    array = np.asarray(img)
    if not (isinstance(img, np.ndarray) and img.dtype == np.uint8 and img.ndim == 3 and img.shape[2] == 3 and img.size):
        raise ValueError(f"{name}: expected (H, W, 3) uint8 RGB, got {array.dtype} of shape {array.shape}")
