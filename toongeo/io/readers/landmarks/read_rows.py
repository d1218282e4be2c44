"""Landmarks as plain text: a point a line, or a face a line."""

from pathlib import Path

import numpy as np

from toongeo.io.landmarks.landmark_schemes import SCHEMES
from toongeo.io.readers.landmarks.file_contents import file_lines
from toongeo.io.readers.landmarks.number_words import number, words
from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks, face_points

__all__ = ["points_of_lines", "read_rows"]

_COUNTS = tuple(count for counts in SCHEMES.values() for count in counts)
# A line with so many words holds a face, not a point.
_WORDS_OF_A_FACE = 2 * min(_COUNTS)

_Lines = list[tuple[int, str]]


def read_rows(path: Path, shift: int = 0) -> RawLandmarks:
    """Points as ``x y`` lines (or ``x y z``, ``k x y``, ``(x, y)``), or whole faces as lines, as WFLW's lists are.

    A heading, a first line that is the number of points, and lines that start with ``#`` are skipped.

    Raises
    ------
    ValueError, OSError
        If it is no text, or a line is something else: says which.
    """
    lines = file_lines(path)
    if lines and all(number(word) is None for word in words(lines[0][1])):
        lines = lines[1:]
    if lines and all(len(line) >= _WORDS_OF_A_FACE and len(words(line)) >= _WORDS_OF_A_FACE for _, line in lines):
        return RawLandmarks("a face a line", tuple((_face(line, k, path, shift),) for k, line in lines))
    if len(lines) > 1 and words(lines[0][1]) == [str(len(lines) - 1)]:
        lines = lines[1:]
    return RawLandmarks("text", ((points_of_lines(lines, path, shift),),))


def points_of_lines(lines: _Lines, path: Path, shift: int) -> np.ndarray:
    """Points (k, 2) of numbered lines, each of two or three numbers, or one more if the first is a running index."""
    rows: list[list[float | None]] = []
    for k, line in lines:
        row = [number(word, 0) for word in words(line)]
        if None in row or len(row) not in (2, 3, 4) or len(row) != len(rows[0] if rows else row):
            count = {3: "three", 4: "four"}.get(len(rows[0]) if rows else 2, "two")
            raise ValueError(f"path: expected {count} numbers, got {line.strip()[:60]!r} in line {k} of {path}")
        rows.append(row)
    if not rows:
        raise ValueError(f"path: expected points as lines of two numbers, but there are none in {path}")
    table = np.array(rows, np.float64)
    first = _skipped(table)
    # The words once more, less the shift before they are rounded to floats.
    exact = [[number(word, shift) for word in words(line)[first : first + 2]] for _, line in lines]
    points = face_points(table[:, first:])
    return np.where(np.isnan(points), np.nan, np.array(exact, np.float64).reshape(-1, 2))


def _skipped(table: np.ndarray) -> int:
    """1 if the first of three or four columns counts the points, from 0 or 1; else 0."""
    if table.shape[1] < 3 or not len(table):
        return 0
    counted = any(np.array_equal(table[:, 0], np.arange(len(table)) + start) for start in (0, 1))
    return int(counted)


def _face(line: str, k: int, path: Path, shift: int) -> np.ndarray:
    """The points at the head of a line: all its numbers if some scheme has as many, else the first 98 (WFLW)."""
    found = words(line)
    numbers = [number(word, shift) for word in found]
    ends = next((n for n, value in enumerate(numbers) if value is None), len(numbers))
    wflw = 2 * SCHEMES["wflw98"][0]
    if ends // 2 not in _COUNTS and ends >= wflw:
        ends = wflw  # then come a box, six attributes and the name of the picture
    if ends % 2 or ends // 2 not in _COUNTS:
        raise ValueError(f"path: expected the points of a face, got {ends} numbers in line {k} of {path}")
    return np.array(numbers[:ends], np.float64).reshape(-1, 2)
