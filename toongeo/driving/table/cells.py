"""The cells of a table of text."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from toongeo.arrays import Floats
from toongeo.reading.check_file import check_file

__all__ = ["Table", "read_table"]

_MOST_MB = 128  # three hours of 61 columns at 60 frames a second; the cells of a text take ten times its size
_DELIMITERS = (",", ";", "\t")
_LOST = {"", "nan", "none", "null", "-"}  # how programs write that there is no number


@dataclass(frozen=True, eq=False)
class Table:
    """Lines of cells under a heading.

    Attributes
    ----------
    path : Path
    heading : list of str
    rows : list of list of str
        Each as long as the heading; a frame without a face, which programs write in a few cells, is filled with "".
    lines : list of int
        Their line numbers in the file.
    notes : tuple of str
        What was left out.
    """

    path: Path
    heading: list[str]
    rows: list[list[str]]
    lines: list[int]
    notes: tuple[str, ...]

    def column(self, *names: str) -> int | None:
        """Index of the first column that has one of some names, in any case."""
        lower = [cell.lower() for cell in self.heading]
        return next((lower.index(name) for name in names if name in lower), None)

    def numbers(self, column: int) -> Floats:
        """A column (f,) of numbers; NaN where there is none.

        Raises
        ------
        ValueError
            If a cell holds something else; says where.
        """
        values = np.empty(len(self.rows))
        for frame, row in enumerate(self.rows):
            cell = row[column].strip()
            try:
                values[frame] = np.nan if cell.lower() in _LOST else float(cell.replace(",", "."))
                fine = not np.isinf(values[frame])
            except ValueError:
                fine = False
            if not fine:
                where = f"{self.path}, line {self.lines[frame]}"
                raise ValueError(f"{where}: expected a number in column {self.heading[column]}, got {cell!r}")
        return values


def read_table(path: Path) -> Table:
    """A table parted by commas, semicolons or tabs.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is not text, has no line below the heading, or a line has more or fewer cells than the heading.
    """
    found = _lines(path)
    if len(found) < 2:
        raise ValueError(f"{path}: expected a heading and at least one frame, got {len(found)} lines")
    heading = [cell.strip() for cell in found[0][1]]
    while heading and not heading[-1]:  # each line ends in a delimiter
        heading.pop()
    count = next((k for k, cell in enumerate(heading) if cell.lower() == "blendshapecount"), None)
    rows: list[list[str]] = []
    lines: list[int] = []
    notes: list[str] = []
    for number, cells in found[1:]:
        surplus = [cell for cell in cells[len(heading) :] if cell.strip()]
        row = cells[: len(heading)]
        lost = count is not None and len(row) > count and row[count].strip() == "0"
        if len(row) < len(heading) and not lost and number == found[-1][0] and len(rows) > 0:
            notes.append(f"line {number}, the last, is cut off and was left out")
            continue
        if surplus or (len(row) < len(heading) and not lost):
            raise ValueError(
                f"{path}, line {number}: expected {len(heading)} cells as in the heading, got {len(cells)}"
            )
        rows.append([*row, *[""] * (len(heading) - len(row))])
        lines.append(number)
    return Table(path, heading, rows, lines, tuple(notes))


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    """The lines that are not empty, with their numbers."""
    try:
        check_file(path, _MOST_MB)
        with open(path, encoding="utf-8-sig", newline="") as file:
            heading = file.readline()
            file.seek(0)
            reader = csv.reader(file, delimiter=max(_DELIMITERS, key=heading.count))
            return [(reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{path}: expected a CSV file in UTF-8, got something else ({error})") from None
