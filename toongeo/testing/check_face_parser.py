"""Whether something is a `FaceParser`."""

from __future__ import annotations

import numpy as np

from toongeo.protocols import FaceLabel, FaceParse, FaceParser
from toongeo.testing.example import example, fitted_example, require, unchanged

__all__ = ["check_face_parser"]


def check_face_parser(parser: FaceParser) -> None:
    """Call a parser with and without a fitted face, and with landmarks missing.

    Parameters
    ----------
    parser : FaceParser

    Raises
    ------
    AssertionError
        If it does not return a FaceParse of the picture's size in which skin is found, gives another one the second
        time, or writes to its arguments.

    Examples
    --------
    >>> from toongeo import ClassicalParser
    >>> check_face_parser(ClassicalParser())
    """
    img, points = (np.array(part) for part in example())
    holes = points.copy()
    holes[[0, 1, 16]] = np.nan
    for landmarks, fit in ((points, fitted_example()), (points, None), (holes, fitted_example())):
        before = img.copy(), landmarks.copy()
        found = parser(img, landmarks, fit)
        require(isinstance(found, FaceParse), f"parser: expected FaceParse, got {type(found).__name__}")
        require(found.labels.shape == img.shape[:2], f"labels: expected {img.shape[:2]}, got {found.labels.shape}")
        require(found.mask(FaceLabel.SKIN).any(), "labels: expected some skin, got none")
        unchanged("img", before[0], img)
        unchanged("landmarks", before[1], landmarks)
    again = parser(img, holes, fitted_example())
    require(np.array_equal(again.labels, found.labels), "labels: expected the same a second time")
