"""Landmark files into pixels."""

import os

import numpy as np
from numpy.typing import NDArray

from toongeo.io.readers.landmarks.placed_landmarks import PictureSize
from toongeo.io.readers.read_landmark_file import read_landmark_file

__all__ = ["read_landmarks"]


def read_landmarks(
    path: str | os.PathLike[str],
    *,
    scheme: str = "auto",
    face: int = 0,
    frame: int | None = None,
    size: PictureSize | None = None,
    one_based: bool | None = None,
) -> NDArray[np.float64]:
    """Read 68 landmarks in iBUG order from a file of any usual format.

    :func:`read_landmark_file` reads the same and says what was found.

    Parameters
    ----------
    path
        ``.pts`` (iBUG and menpo: 1-based), ``.npy``, ``.csv`` and ``.txt`` (``x y`` or ``x,y`` in each line, OpenFace's
        tables, WFLW's lists), ``.json`` (lists, MediaPipe, COCO, OpenPose), ``.ljson`` (landmarker.io), ``.xml``
        (dlib). A missing point is NaN, null or an empty cell.
    scheme, face, frame, size, one_based
        See :func:`read_landmark_file`; what the file tells by itself need not be given.

    Returns
    -------
    (68, 2) float64
        Pixels: x right, y down, integer = centre of a pixel, the first pixel is 0. Missing points, and those that
        another scheme does not have, are NaN rows.

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If the format is unknown, the file is damaged, or it holds another number of points than the schemes known.
        The order and the place of the points are for :func:`check_landmarks`.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "face.txt"
    >>> _ = path.write_text("10.5 20\\n" * 68)
    >>> read_landmarks(path)[0]
    array([10.5, 20. ])
    """
    found = read_landmark_file(path, scheme=scheme, face=face, frame=frame, size=size, one_based=one_based)
    return found.points.copy()
