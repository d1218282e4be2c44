"""The package ``av`` (PyAV), if it is installed."""

import importlib
import importlib.util
from pathlib import Path
from typing import Any

from toongeo.reading.check_file import check_kind

__all__ = ["has_pyav", "has_sound", "load_pyav"]


def has_pyav() -> bool:
    """Whether it is installed."""
    return importlib.util.find_spec("av") is not None


def load_pyav(purpose: str) -> Any:
    """The module.

    Raises
    ------
    ImportError
        If it is not installed; says for what it is needed, and which extra has it.
    """
    if not has_pyav():
        raise ImportError(f'{purpose} needs PyAV: pip install "toongeo[video]"')
    return importlib.import_module("av")


def has_sound(path: Path) -> bool:
    """Whether a file has a sound that can be read; False too if PyAV is missing.

    Raises
    ------
    ValueError
        If it is a device or a pipe.
    """
    check_kind(path, "sound")
    if not has_pyav():
        return False
    av = load_pyav("sound")
    try:
        with av.open(str(path)) as file:
            return bool(file.streams.audio)
    except av.FFmpegError:
        return False
