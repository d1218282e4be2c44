"""The file of a deformation space."""

from __future__ import annotations

import io
import os
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from toongeo.io.atomic_write import atomic_write
from toongeo.reading.read_npz import read_npz

__all__ = ["read_arrays", "write_arrays"]

_FORMAT = 1


def write_arrays(path: str | os.PathLike[str], arrays: Mapping[str, NDArray]) -> None:
    """Write named arrays as an ``.npz`` file without pickles; whole, or not at all.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    buffer = io.BytesIO()
    np.savez(buffer, format=np.array(_FORMAT), **arrays)  # type: ignore[arg-type]
    atomic_write({path: buffer.getvalue()})


def read_arrays(path: str | os.PathLike[str], names: Sequence[str]) -> dict[str, NDArray]:
    """Read what `write_arrays` wrote.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it holds something else.
    """
    expected = f"a deformation space of format {_FORMAT}"
    arrays = read_npz(path, ("format", *names), expected=expected)
    found = arrays.pop("format")
    if found.shape != () or found != _FORMAT:
        raise ValueError(f"path: expected {expected}, got format {np.array2string(found)[:40]} in {path}")
    return arrays
