"""Arrays out of an ``.npz`` archive."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Collection
from pathlib import Path

from numpy.typing import NDArray

from toongeo.reading.check_file import MOST_MB, check_file
from toongeo.reading.npy_array import npy_content
from toongeo.reading.promise import promise

__all__ = ["npz_names", "read_npz"]

_MOST_MB = 4096  # of all arrays together, once they are unpacked: four times the largest published face model
_FREE_MB = 64  # are never too many, however small the file
_RATIO = 100  # of arrays to what they take in the file; of the models that we know none is above 20
_KINDS = "biufSU"


def npz_names(path: str | os.PathLike[str], *, expected: str = "an .npz archive", argument: str = "path") -> list[str]:
    """Names of the arrays in an archive, none of them read.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is no archive.
    """
    with Path(path).open("rb") as file, promise(path, expected, argument), zipfile.ZipFile(file) as archive:
        return [name.removesuffix(".npy") for name in archive.namelist()]


def read_npz(
    path: str | os.PathLike[str],
    names: Collection[str] | None = None,
    optional: Collection[str] = (),
    *,
    expected: str,
    argument: str = "path",
    most_mb: int = _MOST_MB,
) -> dict[str, NDArray]:
    """The arrays of these names; none is unpickled, and none is larger than the archive says.

    Nothing is unpacked before its size is known: beyond 64 MB arrays must not be more than 100 times as large as what
    they take in the file.

    Parameters
    ----------
    names
        Of the arrays that must be there; None: all that are.
    optional
        Of those that may be there.
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
    >>> read_npz(path, ["x"], ["y"], expected="three numbers")
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
        missing = sorted(set(names or ()) - set(entries))
        if missing:
            raise ValueError(f"{argument}: expected {expected}, got no {', '.join(map(repr, missing))} in {path}")
        wanted = tuple(entries) if names is None else (*names, *(name for name in optional if name in entries))
        size, packed = (sum(getattr(entries[name], kind) for name in wanted) for kind in ("file_size", "compress_size"))
        if size > most_mb * 2**20:
            raise ValueError(f"{argument}: expected {expected} of at most {most_mb} MB, but {path} has {size >> 20} MB")
        if size > max(_FREE_MB * 2**20, _RATIO * packed):
            most = f"at most {_RATIO} times its {packed} packed bytes"
            raise ValueError(f"{argument}: expected {expected} of {most}, but {path} announces {size}")
        return {name: _array(archive, entries[name]) for name in wanted}


def _array(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> NDArray:
    content = archive.read(entry)
    try:
        return npy_content(content, kinds=_KINDS)
    except ValueError as error:
        raise ValueError(f"array {entry.filename!r}: {error}") from error
