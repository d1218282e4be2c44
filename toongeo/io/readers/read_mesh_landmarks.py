"""Landmarks on a mesh, from a file."""

import os
import reprlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.io.readers.landmarks.file_contents import file_json, file_lines
from toongeo.io.readers.landmarks.json_points import json_number
from toongeo.io.readers.landmarks.number_words import number, words
from toongeo.io.readers.landmarks.read_ljson import is_ljson, ljson_groups
from toongeo.io.readers.landmarks.read_picked_points import read_picked_points
from toongeo.reading.promise import promised

__all__ = ["read_mesh_landmarks"]

_SUFFIXES = (".json", ".ljson", ".pp", ".txt", ".csv")


@promised("landmarks of a mesh")
def read_mesh_landmarks(path: str | os.PathLike[str], vertices: NDArray[np.floating]) -> NDArray[np.float64]:
    """Read 68 landmarks of a mesh in iBUG order.

    Parameters
    ----------
    path
        ``.json``: a list of 68 entries, or an object that holds it as ``"landmarks"``. An entry is the index of a
        vertex, 0-based in the order of the mesh file, or a point ``[x, y, z]`` or ``{"x": x, "y": y, "z": z}``, or
        ``null`` where the landmark is missing. ``.ljson`` or ``.json`` of landmarker.io; ``.pp`` of MeshLab; ``.txt``
        or ``.csv``: a vertex or a point a line.
    vertices
        (n, 3) of the mesh.

    Returns
    -------
    (68, 3) float64
        Points in the frame of the vertices; missing ones are NaN rows.

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If it has another form or number of entries, an index is out of range or no whole number, or all are missing.

    Examples
    --------
    >>> import json, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "head.json"
    >>> _ = path.write_text(json.dumps([1, [0.5, 0, 0], None] + 65 * [0]))
    >>> read_mesh_landmarks(path, np.eye(3))[:3]
    array([[0. , 1. , 0. ],
           [0.5, 0. , 0. ],
           [nan, nan, nan]])
    """
    path = Path(path)
    entries = _entries(path)
    if not isinstance(entries, list) or len(entries) != 68:
        got = f"{len(entries)} entries" if isinstance(entries, list) else type(entries).__name__
        raise ValueError(f'path: expected a list of 68 entries or {{"landmarks": [...]}} in {path}, got {got}')
    points = np.array([_point(entry, k, vertices, path) for k, entry in enumerate(entries)])
    if np.isnan(points).all():
        raise ValueError(f"path: expected at least one landmark in {path}, but all are missing")
    return points


def _entries(path: Path) -> Any:
    suffix = path.suffix.lower()
    if suffix not in _SUFFIXES:
        raise ValueError(f"path: expected {', '.join(_SUFFIXES[:-1])} or {_SUFFIXES[-1]}, got {path}")
    if suffix == ".pp":
        return _rows(read_picked_points(path))
    if suffix in (".txt", ".csv"):
        return _lines(path)
    document = file_json(path)
    if is_ljson(document) and not isinstance(document.get("landmarks"), list):
        return _rows(ljson_groups(document, path)[0])
    return document.get("landmarks") if isinstance(document, dict) else document


def _rows(points: NDArray[np.float64]) -> list[Any]:
    return [None if np.isnan(point).all() else point.tolist() for point in points]


def _lines(path: Path) -> list[Any]:
    """Entries out of lines; a heading and lines that start with ``#`` are skipped."""
    rows = [[number(word) for word in words(line)] for _, line in file_lines(path)]
    if rows and all(value is None for value in rows[0]):
        rows = rows[1:]
    entries: list[Any] = []
    for row in rows:
        missing = bool(row) and all(value is not None and np.isnan(value) for value in row)
        entries.append(None if missing else row[0] if len(row) == 1 else row)
    return entries


def _point(entry: Any, k: int, vertices: NDArray[np.floating], path: Path) -> list[float]:
    if entry is None:
        return [np.nan] * 3
    index = json_number(entry)
    if index is not None and index.is_integer():  # NumPy, pandas and JavaScript write 1985.0
        if not 0 <= index < len(vertices):
            shown = reprlib.repr(entry)
            raise ValueError(f"path: landmark {k} in {path}: expected a vertex in 0..{len(vertices) - 1}, got {shown}")
        return [float(x) for x in vertices[int(index)]]
    if isinstance(entry, dict):
        entry = [entry.get(axis) for axis in "xyz"]
    numbers = [json_number(x) for x in entry] if isinstance(entry, list) else []
    point = [x for x in numbers if x is not None and np.isfinite(x)]
    if len(point) == len(numbers) == 3:
        return point
    raise ValueError(f"path: landmark {k} in {path}: expected a vertex, [x, y, z] or null, got {reprlib.repr(entry)}")
