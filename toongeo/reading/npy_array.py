"""An array in NumPy's own format, whose size is looked at before memory is taken."""

from __future__ import annotations

import io
import math
import warnings
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["npy_array", "npy_content"]

_HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}


def npy_array(stream: IO[bytes], held: int, *, kinds: str = "iuf", most_numbers: int = 2**28) -> NDArray:
    """Read an array of plain numbers, which cannot be written to; pickles never.

    Parameters
    ----------
    stream
        At its beginning.
    held
        Bytes of the stream in all.
    kinds
        Of NumPy's types that are taken: ``"b"`` truth values, ``"iuf"`` numbers, ``"SU"`` texts.
    most_numbers
        That are read; 2**28 doubles are 2 GB.

    Raises
    ------
    ValueError
        If the header is damaged or announces more than there is, or another type. What NumPy's parser of headers
        raises besides is for :func:`toongeo.reading.promise.promise`.
    """
    shape, fortran, dtype = _header(stream, held, kinds, most_numbers)
    count = math.prod(shape)
    content = stream.read(count * dtype.itemsize)
    if len(content) != count * dtype.itemsize:
        raise ValueError(f"the shape is {shape}, but {len(content)} bytes follow")
    return _shaped(content, 0, shape, fortran, dtype)


def npy_content(content: bytes, *, kinds: str = "iuf") -> NDArray:
    """The array of a whole file in memory, without a copy; otherwise as `npy_array`.

    Raises
    ------
    ValueError
        As `npy_array`, and if more bytes follow than the array takes.
    """
    stream = io.BytesIO(content)
    shape, fortran, dtype = _header(stream, len(content), kinds, len(content))
    start = stream.tell()
    if len(content) - start != math.prod(shape) * dtype.itemsize:
        raise ValueError(f"the shape is {shape}, but more bytes follow")
    return _shaped(content, start, shape, fortran, dtype)


def _header(stream: IO[bytes], held: int, kinds: str, most_numbers: int) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Shape, whether the first axis varies fastest, and type; refused are those that the stream cannot hold."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of headers written by Python 2
        version = np.lib.format.read_magic(stream)
        if version not in _HEADERS:
            raise ValueError(f"version {version} of the format is not known here")
        shape, fortran, dtype = _HEADERS[version](stream)
    if dtype.kind not in kinds:
        raise ValueError(f"got {dtype}")
    if not all(type(n) is int and n >= 0 for n in shape):
        raise ValueError(f"the shape is {shape}")
    left, count = held - stream.tell(), math.prod(shape)
    if count > most_numbers or count * dtype.itemsize > left:
        raise ValueError(f"the shape is {shape}, but {left} bytes follow, and at most {most_numbers} are read")
    return shape, fortran, dtype


def _shaped(content: bytes, start: int, shape: tuple[int, ...], fortran: bool, dtype: np.dtype[Any]) -> NDArray:
    count = math.prod(shape)
    array = np.frombuffer(content, dtype, count, start) if count and dtype.itemsize else np.zeros(count, dtype)
    return array.reshape(shape, order="F" if fortran else "C")
