"""Landmarks into a file."""

import io
import json
import os
from decimal import Decimal
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.io.atomic_write import atomic_write
from toongeo.io.landmark_array import landmark_array
from toongeo.io.readers.read_landmarks import EXACT

__all__ = ["write_landmarks"]


def write_landmarks(path: str | os.PathLike[str], landmarks: ArrayLike) -> None:
    """Write 68 landmarks; :func:`read_landmarks` reads the very same numbers back.

    Parameters
    ----------
    path
        ``.pts`` (1 is added, as iBUG has it), ``.npy``, ``.csv`` (with a heading ``x,y``), ``.txt`` or ``.json``
        (``{"landmarks": [[x, y], ...]}``, null where a point is missing); atomic.
    landmarks
        (68, 2) px, 0-based; NaN rows are missing points.

    Raises
    ------
    ValueError
        If the suffix is unknown or ``landmarks`` is not (68, 2), holds infinity or nothing but NaN.
    OSError
        If the path cannot be written.
    """
    points = landmark_array(landmarks)
    suffix = Path(path).suffix.lower()
    if suffix == ".npy":
        stream = io.BytesIO()
        np.save(stream, points, allow_pickle=False)
        content = stream.getvalue()
    elif suffix == ".pts":
        content = f"version: 1\nn_points: 68\n{{\n{_lines(points, ' ', 1)}\n}}\n".encode()
    elif suffix == ".csv":
        content = f"x,y\n{_lines(points, ',', 0)}\n".encode()
    elif suffix == ".txt":
        content = f"{_lines(points, ' ', 0)}\n".encode()
    elif suffix == ".json":
        rows = [None if np.isnan(row[0]) else row for row in points.tolist()]
        content = (json.dumps({"scheme": "ibug68", "landmarks": rows}) + "\n").encode()
    else:
        raise ValueError(f"path: expected .pts, .npy, .csv, .txt or .json, got {path}")
    atomic_write({path: content})


def _lines(points: NDArray[np.float64], separator: str, shift: int) -> str:
    return "\n".join(separator.join(_text(value, shift) for value in row) for row in points.tolist())


def _text(value: float, shift: int) -> str:
    """Shortest decimal that names this float, moved by ``shift`` without rounding."""
    return str(EXACT.add(Decimal(repr(value)), shift)).lower() if shift else repr(value)
