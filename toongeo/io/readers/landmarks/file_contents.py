"""Contents of files, of bounded size."""

import json
from pathlib import Path
from typing import Any

from toongeo.reading.check_file import MOST_MB, file_bytes
from toongeo.reading.decoded import decoded

__all__ = ["file_json", "file_lines"]

_MOST_LINES = 500_000
_LINE_ENDS = "\n\r\v\f\x1c\x1d\x1e\x85\u2028\u2029"  # at which str.splitlines splits
# Python objects of a JSON text take ten to thirty times its size.
_MOST_JSON_MB = 64


def file_lines(path: Path) -> list[tuple[int, str]]:
    """The lines of a text with their numbers, but blank ones and those that start with ``#``.

    Raises
    ------
    ValueError, OSError
        If it is no text or has too many lines.
    """
    text = _text(path, MOST_MB)
    if sum(map(text.count, _LINE_ENDS)) > _MOST_LINES:
        raise ValueError(f"path: expected at most {_MOST_LINES} lines, but {path} has more")
    lines = enumerate(text.splitlines(), start=1)
    return [(k, line) for k, line in lines if line.strip() and not line.lstrip().startswith("#")]


def _text(path: Path, most_mb: int) -> str:
    """UTF-8, or UTF-16 that says so by its first bytes."""
    content = file_bytes(path, most_mb)
    try:
        return decoded(content)
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
