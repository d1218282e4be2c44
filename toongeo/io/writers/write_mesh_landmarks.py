"""Landmarks on a mesh into a file."""

import json
import os
from collections.abc import Sequence

from toongeo.io.atomic_write import atomic_write
from toongeo.reading.check_file import file_name

__all__ = ["write_mesh_landmarks"]


def write_mesh_landmarks(path: str | os.PathLike[str], vertices: Sequence[int | None]) -> None:
    """Write the vertices of 68 landmarks; :func:`read_mesh_landmarks` and ``load_model(landmarks=...)`` read them.

    Parameters
    ----------
    path
        ``.json``: a list, null where one is missing. ``.txt``: one a line, ``nan`` where one is missing. Atomic.
    vertices
        68 indices, 0-based in the order of the mesh file; None: missing.

    Raises
    ------
    ValueError
        If the suffix is another, there are other than 68, one is negative or no whole number, or all are missing.
    OSError
        If the path cannot be written.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "head.json"
    >>> write_mesh_landmarks(path, [4, None] + 66 * [0])
    >>> path.read_text()[:9]
    '[4, null,'
    """
    entries = list(vertices)
    if len(entries) != 68:
        raise ValueError(f"vertices: expected 68, got {len(entries)}")
    for k, vertex in enumerate(entries):
        if vertex is not None and (isinstance(vertex, bool) or int(vertex) != vertex or vertex < 0):
            raise ValueError(f"vertices: expected whole numbers from 0 or None, got {vertex!r} for landmark {k}")
    if all(vertex is None for vertex in entries):
        raise ValueError("vertices: expected at least one landmark, but all are missing")
    numbers = [None if vertex is None else int(vertex) for vertex in entries]
    suffix = file_name(path).suffix.lower()
    if suffix == ".json":
        text = json.dumps(numbers)
    elif suffix == ".txt":
        text = "\n".join("nan" if number is None else str(number) for number in numbers)
    else:
        raise ValueError(f"path: expected .json or .txt, got {path}")
    atomic_write({path: f"{text}\n".encode()})
