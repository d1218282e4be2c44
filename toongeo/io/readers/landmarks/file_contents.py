"""Contents of files, of bounded size."""

import json
import stat
from pathlib import Path
from typing import Any

__all__ = ["check_file", "file_bytes", "file_json", "file_lines"]

# An hour of OpenFace's table fits, at 30 frames a second.
_MOST_MB = 512
_MOST_LINES = 500_000
_LINE_ENDS = "\n\r\v\f\x1c\x1d\x1e\x85\u2028\u2029"  # at which str.splitlines splits
# Python objects of a JSON text take ten to thirty times its size.
_MOST_JSON_MB = 64


def check_file(path: Path, most_mb: int = _MOST_MB) -> None:
    """Refuse what is no file, or too large, before anything is read.

    Raises
    ------
    OSError
        If it is missing.
    ValueError
        If it is a device or a pipe, or larger than ``most_mb``.
    """
    status = path.stat()
    if not (stat.S_ISREG(status.st_mode) or stat.S_ISDIR(status.st_mode)):
        raise ValueError(f"path: expected a file, but {path} is a device or a pipe")
    if status.st_size > most_mb * 2**20:
        raise ValueError(f"path: expected a file of at most {most_mb} MB, but {path} is larger")


def file_bytes(path: Path, most_mb: int = _MOST_MB) -> bytes:
    """The whole file.

    Raises
    ------
    ValueError, OSError
        As `check_file`, and if it cannot be read.
    """
    check_file(path, most_mb)
    return path.read_bytes()


def file_lines(path: Path) -> list[tuple[int, str]]:
    """The lines of a text with their numbers, but blank ones and those that start with ``#``.

    Raises
    ------
    ValueError, OSError
        If it is no text or has too many lines.
    """
    text = _text(path, _MOST_MB)
    if sum(map(text.count, _LINE_ENDS)) > _MOST_LINES:
        raise ValueError(f"path: expected at most {_MOST_LINES} lines, but {path} has more")
    lines = enumerate(text.splitlines(), start=1)
    return [(k, line) for k, line in lines if line.strip() and not line.lstrip().startswith("#")]


def _text(path: Path, most_mb: int) -> str:
    """UTF-8, or UTF-16 that says so by its first bytes."""
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
        If it is no text, no JSON, or nested too deeply.
    """
    text = _text(path, _MOST_JSON_MB)
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError(f"path: expected JSON, but {path} is nested too deeply") from None
    except ValueError as error:
        raise ValueError(f"path: expected JSON, but in {path}: {error}") from error
