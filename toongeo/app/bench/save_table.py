"""A table as text on standard output and, if wanted, as files."""

from __future__ import annotations

import os
from pathlib import Path

from toongeo.app.bench.bar_chart import bar_chart
from toongeo.app.bench.bench_table import BenchTable, table_csv, table_text
from toongeo.io import atomic_write
from toongeo.io.side_files import check_side_files, marked_picture

__all__ = ["check_table", "save_table"]

_HEADING = b"picture,method,"  # a CSV file has no place for a mark


def save_table(table: BenchTable, name: str, folder: Path | None) -> None:
    """Print a table; with a folder, write ``name.csv`` and ``name.png`` there, both or neither.

    Raises
    ------
    FileExistsError
        As of `check_table`.
    OSError
        If the folder cannot be made or written to.
    """
    print(table_text(table))
    if folder is None:
        return
    check_table(name, folder)
    folder.mkdir(parents=True, exist_ok=True)
    files: dict[str | os.PathLike[str], bytes] = {
        folder / f"{name}.csv": table_csv(table).encode(),
        folder / f"{name}.png": marked_picture(bar_chart(table), f"toongeo bench {name}"),
    }
    atomic_write(files)
    print("wrote " + ", ".join(str(path) for path in files))


def check_table(name: str, folder: Path) -> None:
    """Refuse to replace a file in the folder that is no earlier table of this name.

    Raises
    ------
    FileExistsError
        If there is one.
    """
    text = folder / f"{name}.csv"
    unknown = [] if text.is_file() and _heading(text) == _HEADING else [text]
    check_side_files([folder / f"{name}.png", *unknown], f"toongeo bench {name}")


def _heading(path: Path) -> bytes:
    with path.open("rb") as stream:
        return stream.read(len(_HEADING))
