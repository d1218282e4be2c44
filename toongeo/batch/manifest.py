"""The list of what a batch did, a line of JSON a picture."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

__all__ = ["MANIFEST", "Record", "append_record", "read_manifest"]

MANIFEST = "manifest.jsonl"
Record = dict[str, Any]


def append_record(path: Path, record: Mapping[str, Any]) -> None:
    """Add a line, whole and on the disk, or not at all.

    A line that a crash has cut off before is closed first, so that it spoils no other.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    line = json.dumps(record, separators=(",", ":"), allow_nan=False).encode() + b"\n"
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
    try:
        size = os.fstat(descriptor).st_size
        if size and os.pread(descriptor, 1, size - 1) != b"\n":
            line = b"\n" + line
        os.write(descriptor, line)  # one call: lines of two writers do not mix
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def read_manifest(path: str | os.PathLike[str]) -> dict[str, Record]:
    """The latest record of each picture, by its name in the manifest; lines that were cut off are left out.

    Parameters
    ----------
    path
        ``manifest.jsonl`` of a batch, or its folder.

    Returns
    -------
    dict
        Each record has ``picture``, ``status`` (``"done"``, ``"refused"``, ``"over time"``, ``"over memory"`` or
        ``"killed"``), ``error``, ``input`` and ``output_sha256`` (SHA-256), ``options`` (digest), ``version``,
        ``seconds`` by stage, ``metrics``, ``warnings`` and ``peak_mb``.

    Raises
    ------
    OSError
        If it cannot be read.

    Examples
    --------
    >>> from pathlib import Path
    >>> from toongeo.batch import read_manifest
    >>> lines = ['{"picture": "a.png", "status": "refused"}', '{"picture": "a.png", "status": "done"}', '{"pict']
    >>> size = Path("manifest.jsonl").write_text("\\n".join(lines))
    >>> read_manifest("manifest.jsonl")
    {'a.png': {'picture': 'a.png', 'status': 'done'}}
    """
    path = Path(path)
    records: dict[str, Record] = {}
    with (path / MANIFEST if path.is_dir() else path).open("rb") as lines:
        for line in lines:
            try:
                record = json.loads(line)
            except (ValueError, RecursionError):
                continue
            if isinstance(record, dict) and isinstance(record.get("picture"), str):
                records[record["picture"]] = record
    return records
