"""A table as text on standard output and, if wanted, as files."""

from __future__ import annotations

import os
from pathlib import Path

from toongeo.app.bench.bar_chart import bar_chart
from toongeo.app.bench.bench_table import BenchTable, table_csv, table_text
from toongeo.io import atomic_write, encode_image

__all__ = ["save_table"]


def save_table(table: BenchTable, name: str, folder: Path | None) -> None:
    """Print a table; with a folder, write ``name.csv`` and ``name.png`` there, both or neither.

    Raises
    ------
    OSError
        If the folder cannot be made or written to.
    """
    print(table_text(table))
    if folder is None:
        return
    folder.mkdir(parents=True, exist_ok=True)
    files: dict[str | os.PathLike[str], bytes] = {
        folder / f"{name}.csv": table_csv(table).encode(),
        folder / f"{name}.png": encode_image(bar_chart(table)),
    }
    atomic_write(files)
    print("wrote " + ", ".join(str(path) for path in files))
