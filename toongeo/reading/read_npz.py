"""Arrays out of an ``.npz`` archive."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Sequence
from pathlib import Path

from numpy.typing import NDArray

from toongeo.reading.check_file import MOST_MB, check_file
from toongeo.reading.npy_array import npy_array
from toongeo.reading.promise import promise

__all__ = ["read_npz"]

_MOST_MB = 2048  # of all arrays together, once they are unpacked
_KINDS = "biufU"


def read_npz(
    path: str | os.PathLike[str],
    names: Sequence[str] | None = None,
    *,
    expected: str,
    argument: str = "path",
    most_mb: int = _MOST_MB,
) -> dict[str, NDArray]:
    """The arrays of these names; none is unpickled, and none is larger than the archive says.

    Parameters
    ----------
    names
        Of the arrays; None: all.
    expected
        What the file should be, for messages: ``"a deformation space"``.
    argument
        What the caller calls ``path``.
    most_mb
        Of these arrays together.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is no archive, damaged, too large, or misses an array; says which.

    Examples
    --------
    >>> import numpy as np, pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "a.npz"
    >>> np.savez(path, x=np.arange(3))
    >>> read_npz(path, ["x"], expected="three numbers")
    {'x': array([0, 1, 2])}
    >>> read_npz(path, ["y"], expected="three numbers")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    ValueError: path: expected three numbers, got no 'y' in ...
    """
    check_file(path, max(most_mb, MOST_MB), argument)
    # Not zipfile's own opening of a name: what is no archive is told from what cannot be read.
    with Path(path).open("rb") as file, promise(path, expected, argument), zipfile.ZipFile(file) as archive:
        entries = {entry.filename.removesuffix(".npy"): entry for entry in archive.infolist()}
        names = tuple(entries) if names is None else tuple(names)
        missing = [name for name in names if name not in entries]
        if missing:
            raise ValueError(f"{argument}: expected {expected}, got no {missing[0]!r} in {path}")
        size = sum(entries[name].file_size for name in names)
        if size > most_mb * 2**20:
            raise ValueError(f"{argument}: expected {expected} of at most {most_mb} MB, but {path} has {size >> 20} MB")
        return {name: _array(archive, entries[name]) for name in names}


def _array(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> NDArray:
    with archive.open(entry) as stream:
        try:
            return npy_array(stream, entry.file_size, kinds=_KINDS)
        except ValueError as error:
            raise ValueError(f"array {entry.filename!r}: {error}") from error
