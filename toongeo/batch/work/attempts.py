"""Marks of a worker at work, which outlive it."""

from __future__ import annotations

import os
from pathlib import Path

__all__ = ["Attempts"]

_MOST = 2  # a worker that was killed at a picture is given one more
_BEGUN = b"1"
_LAST_WORDS = {"time": b"T", "memory": b"M"}


class Attempts:
    """How often a picture was begun and not ended: a byte each in a file that is there as long.

    Parameters
    ----------
    path : Path
        Its folder exists.
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    def _read(self) -> bytes:
        try:
            return self.path.read_bytes()
        except FileNotFoundError:
            return b""

    @property
    def begun(self) -> int:
        """Times."""
        return self._read().count(_BEGUN)

    @property
    def last_words(self) -> str | None:
        """Why a worker ended itself over it, ``"time"`` or ``"memory"``; None if none did."""
        marks = self._read()
        return next((reason for reason, mark in _LAST_WORDS.items() if mark in marks), None)

    @property
    def is_hopeless(self) -> bool:
        """Whether it is not to be tried again."""
        return self.last_words is not None or self.begun >= _MOST

    def begin(self) -> None:
        """Mark it."""
        self._write(_BEGUN)

    def say(self, reason: str) -> None:
        """Mark why the worker is about to end itself."""
        self._write(_LAST_WORDS[reason])

    def end(self) -> None:
        """It went through, well or not."""
        self.path.unlink(missing_ok=True)

    def _write(self, mark: bytes) -> None:
        descriptor = os.open(self.path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            os.write(descriptor, mark)
        finally:
            os.close(descriptor)
