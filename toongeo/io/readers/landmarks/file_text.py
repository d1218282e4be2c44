"""Contents of files, of bounded size."""

import json
import stat
from pathlib import Path
from typing import Any

__all__ = ["file_bytes", "file_json", "file_text"]

# A day of OpenFace's table has 10 GB; an hour of it fits.
_MOST_MB = 512
# Python objects of a JSON text take ten to thirty times its size.
_MOST_JSON_MB = 64


def file_bytes(path: Path, most_mb: int = _MOST_MB) -> bytes:
    """The whole file.

    Raises
    ------
    OSError
        If it is missing or cannot be read.
    ValueError
        If it is a device or a pipe, or larger than ``most_mb``.
    """
    mode = path.stat().st_mode
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        raise ValueError(f"path: expected a file, but {path} is a device or a pipe")
    with path.open("rb") as stream:
        content = stream.read(most_mb * 2**20 + 1)
    if len(content) > most_mb * 2**20:
        raise ValueError(f"path: expected a file of at most {most_mb} MB, but {path} is larger")
    return content


def file_text(path: Path, most_mb: int = _MOST_MB) -> str:
    """The file as text: UTF-8, or UTF-16 that says so by its first bytes.

    Raises
    ------
    ValueError, OSError
        As `file_bytes`, and if it is no such text.
    """
    content = file_bytes(path, most_mb)
    encoding = "utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    try:
        return content.decode(encoding)
    except UnicodeDecodeError as error:
        raise ValueError(f"path: expected text, but {path} is not ({error})") from error


def file_json(path: Path) -> Any:
    """The file as JSON.

    Raises
    ------
    ValueError, OSError
        As `file_text`, and if it is no JSON or nested too deeply.
    """
    text = file_text(path, _MOST_JSON_MB)
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError(f"path: expected JSON, but {path} is nested too deeply") from None
    except ValueError as error:
        raise ValueError(f"path: expected JSON, but in {path}: {error}") from error
