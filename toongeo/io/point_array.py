"""What every array of points must be, however many there are."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["point_array"]


def point_array(points: ArrayLike, name: str = "landmarks", expected: str = "rows of x and y") -> NDArray[np.float64]:
    """Copy of points as float64, in the shape they have.

    Parameters
    ----------
    points
        Numbers: no text, no truth values, no complex ones. What a masked array hides is NaN.
    name, expected
        Of the argument, and what it should hold, for the message.

    Raises
    ------
    ValueError
        If they are not numbers, or rows differ in length.

    Examples
    --------
    >>> point_array([["1", "2"]])
    Traceback (most recent call last):
        ...
    ValueError: landmarks: expected numbers, got an array of <U1
    """
    try:
        array = np.asarray(points)
    except ValueError:
        raise ValueError(f"{name}: expected {expected}, got rows of different lengths") from None
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name}: expected numbers, got an array of {array.dtype}")
    copy = np.array(array, np.float64)
    if isinstance(points, np.ma.MaskedArray):
        copy[np.ma.getmaskarray(points)] = np.nan
    return copy
