"""Arrays of an HDF5 file, by h5py (the extra ``models``)."""

from __future__ import annotations

import math
from collections.abc import Collection
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo._extras import missing_extra
from toongeo.reading.promise import promise

__all__ = ["read_h5"]

_RATIO = 100  # of an array to the file: as of archives
_FREE_BYTES = 1 << 26


def read_h5(path: Path, names: Collection[str], optional: Collection[str] = ()) -> dict[str, NDArray | str]:
    """Datasets of an HDF5 file by their paths in it; text as such.

    Raises
    ------
    ImportError
        If h5py is not installed.
    ValueError
        If it is no HDF5 file, one is missing, or larger than the file can hold.
    """
    h5py = _h5py()
    size = path.stat().st_size
    with promise(path, "an HDF5 file", alone=True):
        try:
            file = h5py.File(path, "r")
        except OSError as error:
            raise ValueError(f"it cannot be opened: {error}") from error
        with file:
            try:
                return _read(file, h5py, size, names, optional)
            except OSError as error:  # of a damaged block; that the disk failed is told by the next file
                raise ValueError(f"it cannot be read: {error}") from error


def _read(
    file: Any, h5py: ModuleType, size: int, names: Collection[str], optional: Collection[str]
) -> dict[str, NDArray | str]:
    found: dict[str, NDArray | str] = {}
    for name in (*names, *optional):
        item = file.get(name)
        if not isinstance(item, h5py.Dataset):
            if name in names:
                raise ValueError(f"it has no dataset {name}")
            continue
        if h5py.check_string_dtype(item.dtype) is not None:
            if item.shape in ((), (1,)) and item.id.get_storage_size() <= size:
                found[name] = bytes(np.ravel(item[()])[0]).decode("utf-8", "replace")
            continue
        if item.dtype.kind not in "iuf" or item.external or item.is_virtual:
            raise ValueError(f"{name} holds {item.dtype}, not numbers of this file")
        if math.prod(item.shape) * item.dtype.itemsize > max(_FREE_BYTES, _RATIO * size):
            raise ValueError(f"{name} has the shape {item.shape}, more than a file of {size} bytes holds")
        found[name] = np.asarray(item[()])
    return found


def _h5py() -> ModuleType:
    try:
        import h5py
    except ImportError as error:
        raise ImportError(missing_extra("a model in HDF5", "models")) from error
    return h5py
