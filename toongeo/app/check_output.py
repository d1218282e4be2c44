"""What a command would write, looked at before the work."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

from toongeo.io.side_files import check_side_files
from toongeo.io.writers.write_obj import side_paths
from toongeo.io.writers.write_obj_sequence import SEQUENCE

__all__ = ["check_output"]


def check_output(
    output: Path, inputs: Mapping[str, Path | None], format: str | None = None, *, name: str = "output"
) -> None:
    """Refuse an output that could not be written, or would replace a file of the user.

    Parameters
    ----------
    output : Path
        File, or folder of the format ``obj-sequence``.
    inputs : argument -> Path
        The files that the command reads; None where one was not given.
    format : str, optional
        As of :meth:`toongeo.Avatar.save`.
    name : str
        Of the parameter, for messages.

    Raises
    ------
    ValueError
        If the output, or a file beside it, is one of the inputs, under the same name or another; says which.
    FileExistsError
        If a file that is written beside the output is there and was not written for it.
    OSError
        If there is no folder to write to, it cannot be written to, or a folder has the name of the file.
    """
    if not output.parent.is_dir():
        raise OSError(f"{name}: no folder {output.parent} to write {output.name} to")
    if format == "obj-sequence":
        if output.exists() and not output.is_dir():
            raise NotADirectoryError(f"{name}: expected a folder, got the file {output}")
    elif output.is_dir():
        raise IsADirectoryError(f"{name}: cannot write {output}: it is a folder")
    _try(output.parent, name)
    sides, owner = [], output.name
    if format == "obj-sequence":
        sides, owner = side_paths(output / "face.obj"), SEQUENCE
    elif output.suffix.lower() == ".obj":
        sides = side_paths(output)
    for file in (output, *sides):
        for given, source in inputs.items():
            if source is not None and _same(file, source):
                raise ValueError(f"{name}: expected no file that is read, but {file} is the {given} {source}")
    check_side_files(sides, owner)


def _try(folder: Path, name: str) -> None:
    """Whether a file can be made in a folder: permissions alone do not tell of read-only disks, nor to root."""
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        reason = os.strerror(error.errno or errno.EIO)
        raise OSError(error.errno, f"{name}: cannot write to the folder {folder}: {reason}") from error


def _same(file: Path, other: Path) -> bool:
    """Whether two names, through whatever links, are of one file that is there."""
    try:
        return os.path.samefile(file, other)
    except OSError:
        return False
