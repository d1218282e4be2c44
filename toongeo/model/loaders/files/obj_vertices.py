"""Vertices of an OBJ file alone, at once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

__all__ = ["obj_vertices"]


def obj_vertices(path: Path) -> NDArray[np.float32]:
    """Vertices (n, 3) of an OBJ file whose topology is known from another.

    Ten times as fast as reading all of it, which counts for 160 files.

    Raises
    ------
    ValueError
        If a vertex has other than three coordinates.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "a.obj"
    >>> _ = path.write_text("v 1 2 3\\nvt 0 0\\nv 4 5 6\\nf 1 2 1\\n")
    >>> obj_vertices(path)
    array([[1., 2., 3.],
           [4., 5., 6.]], dtype=float32)
    """
    lines = [line[2:] for line in path.read_bytes().split(b"\n") if line.startswith(b"v ")]
    numbers = np.array(b" ".join(lines).split(), np.float64)
    if numbers.size != 3 * len(lines):
        raise ValueError(f"{path.name}: expected 3 coordinates of {len(lines)} vertices, got {numbers.size}")
    return numbers.astype(np.float32).reshape(-1, 3)
