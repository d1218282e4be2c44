"""The file of a deformation space."""

from __future__ import annotations

import io
import os
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from toongeo.io.atomic_write import atomic_write

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
    with np.load(path, allow_pickle=False) as archive:
        missing = [name for name in ("format", *names) if name not in archive]
        if missing or archive["format"] != _FORMAT:
            what = f"no {missing[0]!r}" if missing else f"format {archive['format']}"
            raise ValueError(f"path: expected a deformation space of format {_FORMAT}, got {what} in {path}")
        return {name: archive[name] for name in names}
