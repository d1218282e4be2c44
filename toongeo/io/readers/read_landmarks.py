"""Landmark files into pixels."""

import contextlib
import json
import os
import zipfile
from decimal import Context, Decimal, InvalidOperation
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from toongeo.io.landmark_array import landmark_array

__all__ = ["read_landmarks"]

# Enough digits that adding or subtracting 1 never rounds: 1.1 - 1 is 0.1, and a file reads back bit for bit.
EXACT = Context(prec=1100)


def read_landmarks(
    path: str | os.PathLike[str], *, one_based: bool | None = None, scheme: str = "ibug68"
) -> NDArray[np.float64]:
    """Read landmarks: 68 in iBUG order, or those of another scheme.

    Parameters
    ----------
    path
        ``.pts`` (iBUG: 1-based), ``.npy`` ((68, 2), 0-based), ``.json`` (a list of 68 ``[x, y]``, null where a
        point is missing, or an object that holds it as ``"landmarks"``; 0-based), or ``.csv`` / ``.txt`` with
        ``x y`` or ``x,y`` in each line (0-based; a heading and lines that start with ``#`` are skipped). ``nan nan``
        is a missing point.
    one_based
        Whether 1 must be subtracted; None: as the format has it.
    scheme : str
        Of another than ``"ibug68"`` the points (k, 2) are given back as they are: functions with ``scheme=`` check
        them.

    Returns
    -------
    (68, 2) or (k, 2) float64
        Pixels: x right, y down, integer = centre of a pixel, the first pixel is 0. Missing points are NaN
        rows.

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If the suffix is unknown, a line is not two numbers, or there are not 68 points. The order and the
        place of the points are for :func:`check_landmarks`.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "face.txt"
    >>> _ = path.write_text("10.5 20\\n" * 68)
    >>> read_landmarks(path)[0]
    array([10.5, 20. ])
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in (".pts", ".npy", ".csv", ".txt", ".json"):
        raise ValueError(f"path: expected .pts, .npy, .csv, .txt or .json, got {path}")
    shift = int(suffix == ".pts" if one_based is None else one_based)
    if suffix in (".npy", ".json"):
        points = (_read_npy(path) if suffix == ".npy" else _read_json(path)) - shift
    else:
        points = _read_lines(path, shift)
    return landmark_array(points, f"landmarks in {path}") if scheme == "ibug68" else points


def _read_npy(path: Path) -> NDArray[np.float64]:
    with path.open("rb") as stream:
        try:
            points = np.lib.format.read_array(stream, allow_pickle=False)
        except (ValueError, EOFError, zipfile.BadZipFile) as error:
            raise ValueError(f"path: expected an .npy array of numbers, but in {path}: {error}") from error
    if points.dtype.kind not in "iuf":
        raise ValueError(f"path: expected an .npy array of numbers, got {points.dtype} in {path}")
    return points.astype(np.float64)


def _read_json(path: Path) -> NDArray[np.float64]:
    try:
        entries = json.loads(path.read_text(encoding="utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise ValueError(f"path: expected JSON, but {path} is not ({error})") from error
    entries = entries.get("landmarks") if isinstance(entries, dict) else entries
    if not isinstance(entries, list):
        raise ValueError(f'path: expected a list of points or {{"landmarks": [...]}} in {path}')
    return np.array([_entry(path, k, entry) for k, entry in enumerate(entries)], np.float64).reshape(-1, 2)


def _entry(path: Path, k: int, entry: object) -> tuple[float, float]:
    if entry is None:
        return np.nan, np.nan
    if isinstance(entry, list) and len(entry) == 2 and {type(number) for number in entry} <= {int, float}:
        with contextlib.suppress(OverflowError):
            return float(entry[0]), float(entry[1])
    raise ValueError(f"path: expected [x, y] or null, got {str(entry)[:60]} for point {k} in {path}")


def _read_lines(path: Path, shift: int) -> NDArray[np.float64]:
    try:
        lines = list(enumerate(path.read_text(encoding="utf-8-sig").splitlines(), start=1))
    except UnicodeDecodeError as error:
        raise ValueError(f"path: expected text, but {path} is not ({error})") from error
    if path.suffix.lower() == ".pts":
        lines = _between_braces(path, lines)
    rows = [(number, line) for number, line in lines if line.strip() and not line.lstrip().startswith("#")]
    if rows and path.suffix.lower() != ".pts" and _is_heading(rows[0][1]):
        rows = rows[1:]
    points = []
    for number, line in rows:
        point = _point(line, shift)
        if point is None:
            raise ValueError(f"path: expected two numbers, got {line.strip()[:60]!r} in line {number} of {path}")
        points.append(point)
    return np.array(points, dtype=np.float64).reshape(-1, 2)


def _between_braces(path: Path, lines: list[tuple[int, str]]) -> list[tuple[int, str]]:
    marks = [k for k, (_, line) in enumerate(lines) if line.strip() in ("{", "}")]
    if len(marks) != 2 or [lines[k][1].strip() for k in marks] != ["{", "}"]:
        raise ValueError(f"path: expected one '{{' and one '}}' around the points of a .pts file, but not in {path}")
    body = lines[marks[0] + 1 : marks[1]]
    for _, line in lines[: marks[0]]:
        key, _, value = line.partition(":")
        count = sum(bool(text.strip()) for _, text in body)
        if key.strip() == "n_points" and value.strip().isdigit() and int(value) != count:
            raise ValueError(f"path: {path} announces n_points: {int(value)}, but holds {count}")
    return body


def _is_heading(line: str) -> bool:
    """Two words, none of them a number."""
    words = _words(line)
    return len(words) == 2 and all(_point(f"{word} 0", 0) is None for word in words)


def _words(line: str) -> list[str]:
    return line.replace(",", " ").replace(";", " ").split()


def _point(line: str, shift: int) -> tuple[float, float] | None:
    """The two numbers in a line, less ``shift``; None if they are not two numbers."""
    words = _words(line)
    if len(words) != 2:
        return None
    try:
        x, y = (float(EXACT.subtract(Decimal(word), shift)) for word in words)
    except (InvalidOperation, OverflowError):
        return None
    return x, y
