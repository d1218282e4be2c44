"""The cells of a table of text."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from toongeo.arrays import Floats
from toongeo.reading.check_file import file_bytes
from toongeo.reading.decoded import decoded

__all__ = ["Table", "heading_key", "read_table"]

_MOST_MB = 128  # three hours of 61 columns at 60 frames a second; the cells of a text take ten times its size
_BEFORE = ("#", "sep=")  # a remark of a program; how spreadsheets are told the delimiter
_DELIMITERS = (",", ";", "\t", "|")
# How programs write that there is no number: C, NumPy, JSON, R, pandas, spreadsheets, the C library of Windows.
_LOST = {"", "nan", "none", "null", "-", "na", "n/a", "#n/a", "<na>", "-nan", "nan(ind)", "-nan(ind)"}


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
        """Index of the first column that has one of some names, as `heading_key` writes them."""
        keys = [heading_key(cell) for cell in self.heading]
        return next((keys.index(name) for name in names if name in keys), None)

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


def heading_key(cell: str) -> str:
    """A cell of a heading in small letters, all else ``_``.

    >>> heading_key("Time (s)"), heading_key("TimeStamp[ms]")
    ('time_s', 'timestamp_ms')
    """
    return re.sub("[^a-z0-9]+", "_", cell.lower()).strip("_")


def read_table(path: Path) -> Table:
    """A table parted by commas, semicolons, tabs or bars; ``#`` and ``sep=`` before its heading are passed over.

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
        lost = _is_lost(row, count) or (len(row) == 1 and number != found[-1][0])
        if len(row) < len(heading) and not lost and number == found[-1][0] and len(rows) > 0:
            notes.append(f"line {number}, the last, is cut off and was left out")
            continue
        if surplus or (len(row) < len(heading) and not lost):
            raise ValueError(
                f"{path}, line {number}: expected {len(heading)} cells as in the heading, got {len(cells)}"
            )
        row = row[: (count or 0) + 1] if lost else row
        rows.append([*row, *[""] * (len(heading) - len(row))])
        lines.append(number)
    return Table(path, heading, rows, lines, tuple(notes))


def _is_lost(row: list[str], count: int | None) -> bool:
    """Whether a row says that no expression was seen, and has none, or zeros, in their places."""
    if count is None or len(row) <= count or row[count].strip() != "0":
        return False
    return not any(set(cell.strip().lower()) - set("0.,+-") for cell in row[count + 1 :] if cell.lower() not in _LOST)


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    """The lines that are not empty, with their numbers."""
    try:
        lines = decoded(file_bytes(path, _MOST_MB)).splitlines(keepends=True)
        first = next((k for k, line in enumerate(lines) if not line.lower().startswith(_BEFORE)), 0)
        heading = lines[first] if lines else ""
        reader = csv.reader(lines[first:], delimiter=max(_DELIMITERS, key=heading.count))
        return [(first + reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{path}: expected a CSV file in UTF-8, got something else ({error})") from None
