"""Files of bounded size, and no pipes."""

from __future__ import annotations

import os
import stat
from pathlib import Path

__all__ = ["MOST_MB", "check_file", "check_kind", "file_bytes"]

MOST_MB = 512  # an hour of OpenFace's table fits, at 30 frames a second; and any head in binary


def check_file(path: str | os.PathLike[str], most_mb: int = MOST_MB, argument: str = "path") -> None:
    """Refuse what is no file, or too large, before anything is read.

    Raises
    ------
    OSError
        If it is missing.
    ValueError
        If it is a device or a pipe, which might never end, or larger than ``most_mb``.
    """
    check_kind(path, argument)
    if Path(path).stat().st_size > most_mb * 2**20:
        raise ValueError(f"{argument}: expected a file of at most {most_mb} MB, but {path} is larger")


def check_kind(path: str | os.PathLike[str], argument: str = "path") -> None:
    """Refuse a device or a pipe, whose reader may wait for ever; what is not there is left to who opens it.

    Raises
    ------
    ValueError
        If it is one.
    """
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError):  # not there, or no name
        return
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise ValueError(f"{argument}: expected a file, but {path} is a device or a pipe")


def file_bytes(path: str | os.PathLike[str], most_mb: int = MOST_MB, argument: str = "path") -> bytes:
    """The whole file.

    Raises
    ------
    ValueError, OSError
        As `check_file`, and if it cannot be read.
    """
    check_file(path, most_mb, argument)
    return Path(path).read_bytes()
