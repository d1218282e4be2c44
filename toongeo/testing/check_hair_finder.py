"""Whether something is a `HairFinder`."""

from __future__ import annotations

import numpy as np

from toongeo.protocols import HairFinder, HairMask
from toongeo.testing.example import example, fitted_example, require, unchanged

__all__ = ["check_hair_finder"]


def check_hair_finder(finder: HairFinder) -> None:
    """Call a finder on a picture with hair, and with landmarks missing.

    Parameters
    ----------
    finder : HairFinder

    Raises
    ------
    AssertionError
        If it does not return a HairMask of the picture's size, gives another one the second time, or writes to its
        arguments.

    Examples
    --------
    >>> from toongeo import find_hair
    >>> check_hair_finder(find_hair)
    """
    img, points = (np.array(part) for part in example())
    holes = points.copy()
    holes[[0, 1, 16]] = np.nan
    for landmarks in (points, holes):
        before = img.copy(), landmarks.copy()
        found, again = finder(img, landmarks, fitted_example()), finder(img, landmarks, fitted_example())
        require(isinstance(found, HairMask), f"finder: expected HairMask, got {type(found).__name__}")
        require(found.mask.shape == img.shape[:2], f"mask: expected {img.shape[:2]}, got {found.mask.shape}")
        require(np.array_equal(found.mask, again.mask), "mask: expected the same a second time")
        unchanged("img", before[0], img)
        unchanged("landmarks", before[1], landmarks)
