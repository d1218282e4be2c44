"""Writing head.npz and its tables: to temporary files first, so that a reader never sees half a template."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import numpy as np
from regions import DESCRIPTIONS
from source import Ints

from toongeo.model.ibug68 import NAMES


def write_archive(folder: Path, arrays: dict[str, np.ndarray]) -> None:
    """Write ``head.npz``; the same arrays give the same bytes."""
    temporary = folder / ".head.tmp.npz"
    np.savez_compressed(temporary, **arrays)
    os.replace(temporary, folder / "head.npz")


def write_tables(folder: Path, landmarks: Ints, lines: list[Ints]) -> None:
    """Write the landmark, contour and region tables. The expression table is written by hand."""
    _write(
        folder / "landmarks.csv",
        ["The iBUG-68 landmarks as vertices of the refined head. Left and right are the subject's.",
         "Points 0-16 are the frontal ones of the lines in contours.csv."],
        ["index", "name", "vertex"],
        [[k, NAMES[k], v] for k, v in enumerate(landmarks.tolist())],
    )  # fmt: skip
    _write(
        folder / "contours.csv",
        ["The 17 jaw contour lines: line k holds, front to back, the vertices on which landmark k can lie.",
         "In a given pose it is the first one that turns away from the viewer, else the last."],
        ["line", "vertices"],
        [[k, " ".join(map(str, line.tolist()))] for k, line in enumerate(lines)],
    )  # fmt: skip
    _write(
        folder / "regions.csv",
        ["The vertex regions of the refined head (L1), in the order of the rows of region_bits in head.npz.",
         "Left and right are the subject's. Regions may overlap."],
        ["name", "description"],
        list(DESCRIPTIONS.items()),
    )  # fmt: skip


def _write(path: Path, comments: list[str], header: list[str], rows: list) -> None:
    temporary = path.with_suffix(".tmp")
    with temporary.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(f"# {line}\n" for line in comments)
        csv.writer(file, lineterminator="\n").writerows([header, *rows])
    os.replace(temporary, path)
