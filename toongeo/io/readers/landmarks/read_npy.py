"""Landmarks as NumPy's ``.npy``."""

import math
from pathlib import Path

import numpy as np

from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks, face_points
from toongeo.reading.check_file import check_file
from toongeo.reading.npy_array import npy_array
from toongeo.reading.promise import promise

__all__ = ["read_npy"]

_MOST_NUMBERS = 50_000_000  # 400 MB: three hours of 68 points at 30 frames a second
_MOST_FACES = 1_000_000


def read_npy(path: Path, shift: int = 0) -> RawLandmarks:
    """(k, 2 or 3): a face; (n, k, ...): the faces of a picture, as face-alignment has them; (f, n, k, ...): frames.

    The size is looked at before memory is taken; pickles are never read.

    Raises
    ------
    ValueError, OSError
        If the file holds something else than such numbers.
    """
    check_file(path)
    with path.open("rb") as stream, promise(path, "an .npy array of numbers"):
        array = npy_array(stream, path.stat().st_size, most_numbers=_MOST_NUMBERS)
    if not 2 <= array.ndim <= 4 or array.shape[-1] not in (2, 3) or math.prod(array.shape[:-2]) > _MOST_FACES:
        raise ValueError(
            f"path: expected shape (68, 2), another number of points, (faces, points, 2 or 3) or (frames, faces, "
            f"points, 2 or 3), got {array.shape} in {path}"
        )
    with np.errstate(over="ignore", invalid="ignore"):
        numbers = array.astype(np.float64)
    numbers = numbers.reshape((1,) * (4 - array.ndim) + array.shape)
    return RawLandmarks("NumPy", tuple(tuple(face_points(face, shift) for face in frame) for frame in numbers))
