"""Landmarks on a mesh, from a JSON file."""

import json
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

__all__ = ["read_mesh_landmarks"]


def read_mesh_landmarks(path: str | os.PathLike[str], vertices: NDArray[np.floating]) -> NDArray[np.float64]:
    """Read 68 landmarks of a mesh in iBUG order.

    Parameters
    ----------
    path
        ``.json``: a list of 68 entries, or an object that holds it as ``"landmarks"``. An entry is the index of a
        vertex, 0-based in the order of the mesh file, or a point ``[x, y, z]``, or ``null`` where the landmark is
        missing.
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
        If it is no JSON, has another form or number of entries, or an index is out of range.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "head.json"
    >>> _ = path.write_text(json.dumps([1, [0.5, 0, 0], None] + 65 * [0]))
    >>> read_mesh_landmarks(path, np.eye(3))[:3]
    array([[0. , 1. , 0. ],
           [0.5, 0. , 0. ],
           [nan, nan, nan]])
    """
    path = Path(path)
    try:
        entries = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:  # also of the decoder
        raise ValueError(f"path: expected JSON, but in {path}: {error}") from error
    if isinstance(entries, dict):
        entries = entries.get("landmarks")
    if not isinstance(entries, list) or len(entries) != 68:
        got = f"{len(entries)} entries" if isinstance(entries, list) else type(entries).__name__
        raise ValueError(f'path: expected a list of 68 entries or {{"landmarks": [...]}} in {path}, got {got}')
    return np.array([_point(entry, k, vertices, path) for k, entry in enumerate(entries)])


def _point(entry: object, k: int, vertices: NDArray[np.floating], path: Path) -> list[float]:
    if entry is None:
        return [np.nan] * 3
    if isinstance(entry, int) and not isinstance(entry, bool):
        if not 0 <= entry < len(vertices):
            raise ValueError(f"path: landmark {k} in {path}: expected a vertex in 0..{len(vertices) - 1}, got {entry}")
        return [float(x) for x in vertices[entry]]
    numbers = isinstance(entry, list) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in entry)
    if isinstance(entry, list) and numbers and len(entry) == 3 and np.isfinite(entry).all():
        return [float(x) for x in entry]
    raise ValueError(f"path: landmark {k} in {path}: expected a vertex, [x, y, z] or null, got {str(entry)[:40]}")
