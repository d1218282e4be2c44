"""What a command would write, looked at before the work."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from toongeo.io.side_files import check_side_files
from toongeo.io.writers.write_obj import side_paths
from toongeo.io.writers.write_obj_sequence import SEQUENCE

__all__ = ["check_output"]


def check_output(output: Path, inputs: Mapping[str, Path | None], format: str | None = None) -> None:
    """Refuse an output that could not be written, or would replace a file of the user.

    Parameters
    ----------
    output : Path
        File, or folder of the format ``obj-sequence``.
    inputs : argument -> Path
        The files that the command reads; None where one was not given.
    format : str, optional
        As of :meth:`toongeo.Avatar.save`.

    Raises
    ------
    ValueError
        If the output, or a file beside it, is one of the inputs, under the same name or another; says which.
    FileExistsError
        If a file that is written beside the output is there and was not written for it.
    OSError
        If there is no folder to write to.
    """
    if not output.parent.is_dir():
        raise OSError(f"output: no folder {output.parent} to write {output.name} to")
    sides, owner = [], output.name
    if format == "obj-sequence":
        sides, owner = side_paths(output / "face.obj"), SEQUENCE
    elif output.suffix.lower() == ".obj":
        sides = side_paths(output)
    for file in (output, *sides):
        for name, source in inputs.items():
            if source is not None and _same(file, source):
                raise ValueError(f"output: expected no file that is read, but {file} is the {name} {source}")
    check_side_files(sides, owner)


def _same(file: Path, other: Path) -> bool:
    """Whether two names, through whatever links, are of one file that is there."""
    try:
        return os.path.samefile(file, other)
    except OSError:
        return False
