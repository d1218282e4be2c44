"""Arrays of an ``.npz`` file that may come from anyone."""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Collection
from pathlib import Path

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from toongeo.model.loaders.files.refusing import refusing

__all__ = ["MOST_BYTES", "npz_names", "parsed_npy", "read_npz"]

MOST_BYTES = 1 << 32  # of all arrays that are read: four times the largest published face model
_FREE_BYTES = 1 << 26  # are never too many, however small the file
_RATIO = 100  # of an array to its compressed size; of the models that we know none is above 20


def npz_names(path: Path) -> list[str]:
    """Names of the arrays in an archive, none of them read.

    Raises
    ------
    ValueError
        If it is no archive.
    """
    with refusing(path, "an .npz archive"), zipfile.ZipFile(path) as archive:
        return [name.removesuffix(".npy") for name in archive.namelist()]


def read_npz(path: Path, names: Collection[str], optional: Collection[str] = ()) -> dict[str, NDArray]:
    """Some arrays of an archive, without pickles.

    Nothing is unpacked before its size is known: an array must be as long as its header says, not be more than 100
    times its compressed size unless it is small, and all of them together not above 4 GB.

    Parameters
    ----------
    path : Path
    names : names that must be there
    optional : names that may be there

    Returns
    -------
    name -> array
        Read-only.

    Raises
    ------
    ValueError
        If it is no archive, an array is missing, holds objects, or is not of the size that it says.
    """
    with refusing(path, "an .npz archive of numeric arrays"), zipfile.ZipFile(path) as archive:
        there = {info.filename.removesuffix(".npy"): info for info in archive.infolist()}
        missing = sorted(set(names) - set(there))
        if missing:
            raise ValueError(f"{path}: expected the arrays {', '.join(sorted(names))}, without {', '.join(missing)}")
        wanted = {name: there[name] for name in (*names, *optional) if name in there}
        total = sum(info.file_size for info in wanted.values())
        packed = sum(info.compress_size for info in wanted.values())
        if total > max(_FREE_BYTES, min(MOST_BYTES, _RATIO * packed)):
            raise ValueError(f"{path}: expected at most {_RATIO} times {packed} packed bytes, got {total}")
        return {name: parsed_npy(archive.read(info), name) for name, info in wanted.items()}


def parsed_npy(content: bytes, name: str) -> NDArray:
    """Array of the bytes of an ``.npy`` file; read-only, no copy.

    Raises
    ------
    ValueError
        If it holds objects, or other than as many bytes as its header says.
    """
    stream = io.BytesIO(content)
    version = npy.read_magic(stream)
    read_header = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}.get(version)
    if read_header is None:
        raise ValueError(f"{name}: expected an array of format 1 or 2, got {version}")
    shape, fortran, dtype = read_header(stream)
    if dtype.hasobject or dtype.kind not in "biufUS":
        raise ValueError(f"{name}: expected numbers or text, got {dtype}")
    count, start = math.prod(shape), stream.tell()
    if min(shape, default=0) < 0 or len(content) - start != count * dtype.itemsize:
        raise ValueError(f"{name}: expected {count} x {dtype.itemsize} bytes, got {len(content) - start}")
    if not dtype.itemsize:
        return np.zeros(shape, dtype)
    array = np.frombuffer(content, dtype, count, start)
    return array.reshape(shape, order="F" if fortran else "C")
