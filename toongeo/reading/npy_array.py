"""An array in NumPy's own format, whose size is looked at before memory is taken."""

from __future__ import annotations

import math
import warnings
from typing import IO

import numpy as np
from numpy.typing import NDArray

__all__ = ["npy_array"]

_HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}


def npy_array(stream: IO[bytes], held: int, *, kinds: str = "iuf", most_numbers: int = 2**28) -> NDArray:
    """Read an array of plain numbers; pickles never.

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
    content = bytearray(stream.read(count * dtype.itemsize))
    if len(content) != count * dtype.itemsize:
        raise ValueError(f"the shape is {shape}, but {len(content)} bytes follow")
    array = np.frombuffer(content, dtype, count) if content else np.zeros(count, dtype)
    return array.reshape(shape, order="F" if fortran else "C")
