"""Landmarks as NumPy's ``.npy``."""

import math
import tokenize
import warnings
from pathlib import Path
from typing import BinaryIO

import numpy as np

from toongeo.io.readers.landmarks.file_contents import check_file
from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks, face_points

__all__ = ["read_npy"]

_HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
_MOST_NUMBERS = 50_000_000  # 400 MB: three hours of 68 points at 30 frames a second
_MOST_FACES = 1_000_000
# What NumPy's parser of headers is known to raise on damaged ones.
_DAMAGED = (
    *(ValueError, TypeError, KeyError, OverflowError, EOFError),
    *(SyntaxError, tokenize.TokenError, MemoryError, RecursionError),
)


def read_npy(path: Path, shift: int = 0) -> RawLandmarks:
    """(k, 2 or 3): a face; (n, k, ...): the faces of a picture, as face-alignment has them; (f, n, k, ...): frames.

    The size is looked at before memory is taken; pickles are never read.

    Raises
    ------
    ValueError, OSError
        If the file holds something else than such numbers.
    """
    check_file(path)
    with path.open("rb") as stream, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of headers written by Python 2
        try:
            _check_header(stream)
            stream.seek(0)
            array = np.lib.format.read_array(stream, allow_pickle=False)
        except _DAMAGED as error:
            raise ValueError(f"path: expected an .npy array of numbers, but in {path}: {error}") from error
    if not 2 <= array.ndim <= 4 or array.shape[-1] not in (2, 3) or math.prod(array.shape[:-2]) > _MOST_FACES:
        raise ValueError(
            f"path: expected shape (68, 2), another number of points, (faces, points, 2 or 3) or (frames, faces, "
            f"points, 2 or 3), got {array.shape} in {path}"
        )
    with np.errstate(over="ignore", invalid="ignore"):
        numbers = array.astype(np.float64)
    numbers = numbers.reshape((1,) * (4 - array.ndim) + array.shape)
    return RawLandmarks("NumPy", tuple(tuple(face_points(face, shift) for face in frame) for frame in numbers))


def _check_header(stream: BinaryIO) -> None:
    version = np.lib.format.read_magic(stream)
    if version not in _HEADERS:
        raise ValueError(f"version {version} of the format is not known here")
    shape, _, dtype = _HEADERS[version](stream)
    if dtype.kind not in "iuf":
        raise ValueError(f"got {dtype}")
    if not all(type(n) is int and n >= 0 for n in shape):
        raise ValueError(f"the shape is {shape}")
    start = stream.tell()
    held = stream.seek(0, 2) - start
    if math.prod(shape) > _MOST_NUMBERS or math.prod(shape) * dtype.itemsize > held:
        raise ValueError(f"the shape is {shape}, but {held} bytes follow, and at most {_MOST_NUMBERS} numbers are read")
