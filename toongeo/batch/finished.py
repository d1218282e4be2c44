"""What an earlier run of a batch left."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from toongeo import __version__
from toongeo.batch.batch_options import BatchOptions
from toongeo.batch.picture_jobs import STATE, PictureJob, input_digest

__all__ = ["is_finished", "remove_leftovers"]

_PARTS = ".toongeo-*.tmp"  # as toongeo.io.atomic_write names them


def is_finished(job: PictureJob, record: dict[str, Any] | None, options: BatchOptions) -> bool:
    """Whether a picture need not be done again: same bytes, options and version, and its file is as it was written.

    One that was refused would be again. One that was killed, or took too long or too much, may fare better.
    """
    if record is None or record.get("status") not in ("done", "refused"):
        return False
    try:
        same = record.get("input") == input_digest(job)
        if record["status"] == "done":
            same &= record.get("output_sha256") == hashlib.sha256(job.output.read_bytes()).hexdigest()
    except (OSError, ValueError):
        return False
    return same and record.get("options") == options.digest() and record.get("version") == __version__


def remove_leftovers(output: Path, jobs: Sequence[PictureJob], *, last: bool = False) -> None:
    """Remove parts of files that killed workers left, and the marks of what they were at.

    The folder of the marks is there afterwards, or is not if this is the last that the batch does.
    """
    state = output / STATE
    state.mkdir(parents=True, exist_ok=True)
    for mark in state.iterdir():
        mark.unlink(missing_ok=True)
    for folder in {path.parent for job in jobs for path in (job.output, job.thumbnail)}:
        for part in folder.glob(_PARTS):
            part.unlink(missing_ok=True)
    if last:
        state.rmdir()
