"""Named numbers of a fit in a file: JSON, or NumPy's archive without pickles."""

from __future__ import annotations

import io
import json
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from toongeo.io import atomic_write
from toongeo.reading.check_file import file_bytes

__all__ = ["read_fields", "write_fields"]

_SUFFIXES = (".json", ".npz")
_REST = "rest.json"  # in the archive: what is no array of numbers


def write_fields(path: str | os.PathLike[str], fields: Mapping[str, Any]) -> None:
    """Write a mapping whose values are numbers, texts, None, and lists and mappings of them; atomically.

    Raises
    ------
    ValueError
        If the suffix is neither ``.json`` nor ``.npz``.
    OSError
        If the file cannot be written; nothing half-written is left.
    """
    suffix = _suffix(path)
    if suffix == ".json":
        content = json.dumps(fields, indent=1).encode()
    else:
        arrays: dict[str, Any] = {name: np.array(value) for name, value in fields.items() if isinstance(value, list)}
        rest = {name: value for name, value in fields.items() if name not in arrays}
        arrays[_REST] = np.frombuffer(json.dumps(rest).encode(), np.uint8)
        stream = io.BytesIO()
        np.savez_compressed(stream, **arrays)
        content = stream.getvalue()
    atomic_write({Path(path): content})


def read_fields(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Inverse of `write_fields`; nothing of a file is ever executed.

    Raises
    ------
    ValueError
        If the file is none of these.
    OSError
        If it cannot be read.
    """
    suffix = _suffix(path)
    content = file_bytes(path)
    try:
        if suffix == ".json":
            fields = json.loads(content)
        else:
            with np.load(io.BytesIO(content), allow_pickle=False) as archive:
                arrays = {name: archive[name] for name in archive.files}
            fields = json.loads(arrays.pop(_REST).tobytes()) | {name: array.tolist() for name, array in arrays.items()}
        if not isinstance(fields, dict):
            raise TypeError(f"it holds a {type(fields).__name__}")
    except (ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, RecursionError) as error:
        raise ValueError(f"path: expected a fit that was saved, got {path} ({error})") from error
    return fields


def _suffix(path: str | os.PathLike[str]) -> str:
    suffix = Path(path).suffix.lower()
    if suffix not in _SUFFIXES:
        raise ValueError(f"path: expected a name that ends in {' or '.join(_SUFFIXES)}, got {path}")
    return suffix
