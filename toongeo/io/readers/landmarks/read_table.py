"""Landmarks as ``.csv``: OpenFace's tables, tables with columns x and y, or plain rows."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from toongeo.io.readers.landmarks.file_contents import file_lines
from toongeo.io.readers.landmarks.number_words import number
from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks, face_points
from toongeo.io.readers.landmarks.read_rows import read_rows

__all__ = ["read_table"]

_COORDINATE = re.compile(r"([xy])_?(\d{1,4})")
_FEWEST_COORDINATES = 10  # fewer make no face: x1 and y1 may head two columns
_Row = tuple[int, list[str]]  # number of the line, its cells


def read_table(path: Path, shift: int = 0) -> RawLandmarks:
    """A table whose heading names ``x_0 ... y_0 ...`` (OpenFace) or ``x`` and ``y``; without such a heading, rows.

    In OpenFace's tables a row is a face; ``frame`` says of which frame, and faces with ``success`` 0 were not found.

    Raises
    ------
    ValueError, OSError
        If a row has another number of cells than the heading or a cell is no number, OpenFace was run without 2D
        landmarks, or as `read_rows`.
    """
    lines = file_lines(path)
    heading = _cells(lines[0][1]) if lines else []
    columns = {match.groups(): k for k, name in enumerate(heading) if (match := _COORDINATE.fullmatch(name))}
    lowered = [name.lower() for name in heading]
    if len(columns) >= _FEWEST_COORDINATES:
        return _wide(columns, heading, lines, path, shift)
    if "success" in heading and "confidence" in heading:
        raise ValueError(f"path: {path} is OpenFace's, but without 2D landmarks x_0 ...: run it with -2Dfp")
    if lowered == ["x", "y"] or not {"x", "y"} <= set(lowered):
        return read_rows(path, shift)
    picked = [lowered.index("x"), lowered.index("y")]
    rows = [_numbers(row, picked, path, shift) for row in _rows(lines, heading, path)]
    return RawLandmarks("a table of x and y", ((face_points(rows) if rows else np.empty((0, 2)),),))


def _wide(
    columns: dict[tuple[str, ...], int], heading: list[str], lines: list[tuple[int, str]], path: Path, shift: int
) -> RawLandmarks:
    order = sorted({int(k) for _, k in columns})
    try:
        picked = [columns[axis, str(k)] for k in order for axis in "xy"]
    except KeyError as error:
        raise ValueError(f"path: expected a column x and a column y of each point in {path}, misses {error}") from None
    frame, success = (heading.index(name) if name in heading else None for name in ("frame", "success"))
    frames: dict[str, list[np.ndarray]] = {}
    for row in _rows(lines, heading, path):
        faces = frames.setdefault(str(row[0]) if frame is None else row[1][frame], [])
        if success is None or number(row[1][success]) != 0:
            faces.append(np.array(_numbers(row, picked, path, shift)).reshape(-1, 2))
    if "face" in heading and frame is None:  # of one picture
        frames = {"": [face for faces in frames.values() for face in faces]}
    kind = "OpenFace" if "confidence" in heading else "a face a row"
    return RawLandmarks(kind, tuple(map(tuple, frames.values())))


def _rows(lines: list[tuple[int, str]], heading: list[str], path: Path) -> Iterator[_Row]:
    for k, line in lines[1:]:
        cells = _cells(line)
        if len(cells) != len(heading):
            raise ValueError(f"path: expected {len(heading)} cells, got {len(cells)} in line {k} of {path}")
        yield k, cells


def _cells(line: str) -> list[str]:
    separator = next((mark for mark in (",", ";", "\t") if mark in line), None)
    return [cell.strip().strip('"').strip() for cell in line.split(separator)]


def _numbers(row: _Row, picked: list[int], path: Path, shift: int) -> list[float]:
    found = []
    for column in picked:
        value = number(row[1][column] or "nan", shift)
        if value is None:
            raise ValueError(f"path: expected a number, got {row[1][column][:40]!r} in line {row[0]} of {path}")
        found.append(value)
    return found
