"""Numeric variables of a MATLAB 5 file."""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.reading.promise import promise

__all__ = ["mat_names", "read_mat"]

_HEADER = 128
_COMPRESSED, _MATRIX = 15, 14
_STRUCT = 2  # class of a struct; 6 to 15 are arrays of numbers
_NUMBERS = range(6, 16)
_DTYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_RATIO = 1100  # deflate packs nothing tighter than 1:1032
_MOST_BYTES = 1 << 32  # of a variable that is unpacked: four times the largest published face model
_NAME_BYTES = 4096  # unpacked to learn the name of a variable
_DEPTH = 2  # structs within structs


def mat_names(path: Path) -> list[str]:
    """Names of the variables of a file.

    Raises
    ------
    ValueError
        If it is no MATLAB 5 file.
    """
    with promise(path, "a MATLAB 5 file", alone=True):
        data, order = _content(path)
        return [_name(element, order) for element in _elements(data, order)]


def read_mat(path: Path, names: Collection[str] | None = None) -> dict[str, NDArray | dict[str, NDArray]]:
    """Arrays of numbers of a MATLAB 5 file, and structs of them; everything else is left out.

    The other kinds of a MATLAB file (cells, objects, functions, sparse matrices) hold nothing that a face model needs.

    Parameters
    ----------
    path : Path
    names : names of variables, optional
        All unless given.

    Raises
    ------
    ValueError
        If it is no MATLAB 5 file (MATLAB 7.3 writes another kind), or sizes do not fit.
    """
    with promise(path, "a MATLAB 5 file", alone=True):
        data, order = _content(path)
        found: dict[str, NDArray | dict[str, NDArray]] = {}
        for element in _elements(data, order):
            name = _name(element, order)
            if names is None or name in names:
                value = _matrix(_unpacked(element, order, min(_MOST_BYTES, _RATIO * len(data))), order, 0)
                if value is not None:
                    found[name] = value
        return found


def _content(path: Path) -> tuple[memoryview, str]:
    data = memoryview(path.read_bytes())
    mark = bytes(data[126:128])
    if len(data) < _HEADER or mark not in (b"IM", b"MI") or not bytes(data[:6]) == b"MATLAB":
        raise ValueError("it has no header of MATLAB 5")
    return data, "<" if mark == b"IM" else ">"


def _elements(data: memoryview, order: str) -> list[tuple[int, memoryview]]:
    found, offset = [], _HEADER
    while offset < len(data):
        kind, body, offset = _tag(data, order, offset, pad=False)
        found.append((kind, body))
    return found


def _tag(data: memoryview, order: str, offset: int, *, pad: bool = True) -> tuple[int, memoryview, int]:
    """Kind and bytes of the element at an offset, and where the next one is."""
    kind, size = struct.unpack_from(f"{order}II", data, offset)
    if kind >> 16:  # a small element: its size stands beside its kind, its bytes follow at once
        kind, size = kind & 0xFFFF, kind >> 16
        start, end = offset + 4, offset + 8
        if size > 4:
            raise ValueError(f"a small element has {size} bytes")
    else:
        start = offset + 8
        end = start + size
        if pad:
            end += -size % 8
    if start + size > len(data):
        raise ValueError(f"an element ends at byte {start + size} of {len(data)}")
    return kind, data[start : start + size], end


def _unpacked(element: tuple[int, memoryview], order: str, most: int) -> memoryview:
    kind, body = element
    if kind == _MATRIX:
        return body
    if kind != _COMPRESSED:
        raise ValueError(f"expected a variable, got an element of kind {kind}")
    unpacker = zlib.decompressobj()
    content = memoryview(unpacker.decompress(body, most + 8))
    if len(content) > most:
        raise ValueError(f"a variable unpacks to more than {most} bytes")
    inner, matrix, _ = _tag(content, order, 0)
    if inner != _MATRIX:
        raise ValueError(f"expected a variable, got an element of kind {inner}")
    return matrix


def _name(element: tuple[int, memoryview], order: str) -> str:
    kind, body = element
    if kind == _COMPRESSED:
        body = memoryview(zlib.decompressobj().decompress(body, _NAME_BYTES))[8:]
    elif kind != _MATRIX:
        return ""
    _, _, offset = _tag(body, order, 0)
    _, _, offset = _tag(body, order, offset)
    return bytes(_tag(body, order, offset)[1]).decode("ascii", "replace")


def _matrix(data: memoryview, order: str, depth: int) -> NDArray | dict[str, NDArray] | None:
    _, flags, offset = _tag(data, order, 0)
    bits = struct.unpack_from(f"{order}I", flags)[0]
    kind, is_complex = bits & 0xFF, bits & 0x800
    _, sizes, offset = _tag(data, order, offset)
    shape = tuple(int(n) for n in np.frombuffer(sizes, f"{order}i4"))
    if min(shape, default=-1) < 0:
        raise ValueError(f"a variable has the shape {shape}")
    _, _, offset = _tag(data, order, offset)
    if kind == _STRUCT and math.prod(shape) == 1 and depth < _DEPTH:
        return _struct(data, order, offset, depth)
    if kind not in _NUMBERS or is_complex:
        return None
    storage, body, _ = _tag(data, order, offset)
    if storage not in _DTYPES:
        raise ValueError(f"numbers are stored as kind {storage}")
    numbers = np.frombuffer(body, order + _DTYPES[storage])
    if len(numbers) != math.prod(shape):
        raise ValueError(f"expected {math.prod(shape)} numbers, got {len(numbers)}")
    return numbers.reshape(shape, order="F")


def _struct(data: memoryview, order: str, offset: int, depth: int) -> dict[str, NDArray]:
    _, length, offset = _tag(data, order, offset)
    width = struct.unpack_from(f"{order}i", length)[0]
    _, names, offset = _tag(data, order, offset)
    if width < 1 or len(names) % width:
        raise ValueError(f"names of fields are {len(names)} bytes in pieces of {width}")
    fields: dict[str, NDArray] = {}
    for start in range(0, len(names), width):
        _, body, offset = _tag(data, order, offset)
        value = _matrix(body, order, depth + 1) if len(body) else None
        if isinstance(value, np.ndarray):
            fields[bytes(names[start : start + width]).split(b"\0")[0].decode("ascii", "replace")] = value
    return fields
