"""CSV files of Live Link Face."""

from __future__ import annotations

import csv
import difflib
import os
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from toongeo.arrays import Floats
from toongeo.driving.take import Take
from toongeo.model.expression_schemes import EXPRESSIONS, SCHEMES

__all__ = ["read_live_link", "scheme_matrix"]

_TIMECODE, _COUNT = "timecode", "blendshapecount"
_HEAD = ("HeadYaw", "HeadPitch", "HeadRoll")
_RATES = (24, 25, 30, 48, 50, 60)  # frames a second at which the app records
_USUAL_RATE = 60.0  # its default
_TIME = re.compile(r"(\d+):(\d+):(\d+)[:;](\d+(?:\.\d+)?)")


def read_live_link(path: str | os.PathLike[str], *, fps: float | None = None) -> Take:
    """A take that the app Live Link Face, or another with its columns, has recorded.

    Parameters
    ----------
    path
        A CSV file with a heading. ``Timecode`` and ``BlendShapeCount`` may be absent, and so may the nine rotations;
        the 52 expressions of ARKit must be there, in any order and case.
    fps : float, optional
        Frames a second that the last part of a time code counts, or of a file without. None: the rate that the time
        codes show, or 60.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If a column is missing, twice there or unknown, a line has another number of cells, a cell is not a finite
        number, or the time codes do not increase; says which line and column.
    """
    heading, lines = _cells(Path(path))
    columns = _columns(heading, path)
    values = _numbers(heading, lines, columns, path)
    weights = values @ scheme_matrix("live_link", [columns[i] for i in sorted(columns)])
    names = [columns[i] for i in sorted(columns)]
    head = values[:, [names.index(name) for name in _HEAD]] if set(_HEAD) <= set(names) else None
    return Take(_times(heading, lines, fps, path), weights, head)


def scheme_matrix(scheme: str, names: Sequence[str]) -> Floats:
    """(len(names), 54): what a weight of 1 under each name of a scheme gives to each of our expressions."""
    matrix = np.zeros((len(names), len(EXPRESSIONS)))
    for row, name in zip(matrix, names, strict=True):
        for own, weight in SCHEMES[scheme][name].items():
            row[EXPRESSIONS.index(own)] = weight
    return matrix


def _cells(path: Path) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Heading, and the lines that are not empty with their numbers."""
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file)
            lines = [(reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{path}: expected a CSV file in UTF-8, got something else ({error})") from None
    if len(lines) < 2:
        raise ValueError(f"{path}: expected a heading and at least one frame, got {len(lines)} lines")
    heading = [cell.strip() for cell in lines[0][1]]
    for number, row in lines[1:]:
        if len(row) != len(heading):
            raise ValueError(f"{path}, line {number}: expected {len(heading)} cells as in the heading, got {len(row)}")
    return heading, lines[1:]


def _columns(heading: list[str], path: str | os.PathLike[str]) -> dict[int, str]:
    """Index of a column -> its name in the scheme."""
    known = {name.lower(): name for name in SCHEMES["live_link"]}
    columns: dict[int, str] = {}
    for i, cell in enumerate(heading):
        if cell.lower() in (_TIMECODE, _COUNT):
            continue
        name = known.get(cell.lower())
        if name is None:
            near = difflib.get_close_matches(cell.lower(), known, n=1)
            hint = f"; did you mean {known[near[0]]}?" if near else ""
            raise ValueError(f"{path}: unknown column {cell!r}{hint}")
        if name in columns.values():
            raise ValueError(f"{path}: column {cell!r} is there twice")
        columns[i] = name
    needed = [name for name, weights in SCHEMES["live_link"].items() if weights]
    missing = [name for name in needed if name not in columns.values()]
    if missing:
        raise ValueError(f"{path}: {len(missing)} of {len(needed)} columns are missing: {', '.join(missing)}")
    return columns


def _numbers(
    heading: list[str], lines: list[tuple[int, list[str]]], columns: dict[int, str], path: str | os.PathLike[str]
) -> Floats:
    count = next((i for i, cell in enumerate(heading) if cell.lower() == _COUNT), None)
    values = np.empty((len(lines), len(columns)))
    for frame, (line, row) in enumerate(lines):
        if count is not None and row[count].strip() not in {"52", "61", str(len(columns))}:
            raise ValueError(
                f"{path}, line {line}: expected {len(columns)} in column BlendShapeCount, got {row[count]!r}"
            )
        for k, i in enumerate(sorted(columns)):
            try:
                values[frame, k] = float(row[i])
            except ValueError:
                values[frame, k] = np.nan
            if not np.isfinite(values[frame, k]):
                raise ValueError(f"{path}, line {line}: expected a number in column {heading[i]}, got {row[i]!r}")
    return values


def _times(
    heading: list[str], lines: list[tuple[int, list[str]]], fps: float | None, path: str | os.PathLike[str]
) -> Floats:
    if fps is not None and not (np.isfinite(fps) and fps > 0):
        raise ValueError(f"fps: expected a rate > 0, got {fps!r}")
    column = next((i for i, cell in enumerate(heading) if cell.lower() == _TIMECODE), None)
    if column is None:
        return np.arange(len(lines)) / (fps or _USUAL_RATE)
    parts = np.empty((len(lines), 4))
    for frame, (line, row) in enumerate(lines):
        match = _TIME.fullmatch(row[column].strip())
        if match is None:
            raise ValueError(f"{path}, line {line}: expected HH:MM:SS:FF.f in column Timecode, got {row[column]!r}")
        parts[frame] = [float(part) for part in match.groups()]
    seconds, frames = parts[:, :3] @ [3600.0, 60.0, 1.0], parts[:, 3]
    times = seconds + frames / (fps or _rate(seconds, frames))
    times += 86400.0 * np.r_[0, np.cumsum(np.diff(times) < -43200.0)]  # past midnight
    late = np.flatnonzero(np.diff(times) <= 0)
    if len(late):
        line, row = lines[late[0] + 1]
        raise ValueError(f"{path}, line {line}: expected a Timecode after the one before, got {row[column]!r}")
    return times - times[0]


def _rate(seconds: Floats, frames: Floats) -> float:
    """The least usual rate that has room for all frames of a second, if the last frame of one was seen."""
    if np.ptp(seconds) == 0:
        return _USUAL_RATE
    return float(next((rate for rate in _RATES if rate > frames.max()), _USUAL_RATE))
