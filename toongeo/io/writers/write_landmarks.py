"""Landmarks into a file."""

import io
import json
import os
from decimal import Decimal
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.io.atomic_write import atomic_write
from toongeo.io.landmark_array import landmark_array
from toongeo.io.landmarks.frontal_layout import frontal_layout
from toongeo.io.readers.landmarks.number_words import EXACT
from toongeo.reading.check_file import file_name

__all__ = ["write_landmarks"]


def write_landmarks(path: str | os.PathLike[str], landmarks: ArrayLike) -> None:
    """Write 68 landmarks; :func:`read_landmarks` reads the very same numbers back.

    Parameters
    ----------
    path
        ``.pts`` (1 is added, as iBUG has it), ``.npy``, ``.csv`` (with a heading ``x,y``), ``.txt``, ``.json``
        (``{"landmarks": [[x, y], ...]}``, null for a missing point) or ``.ljson`` (version 2 of landmarker.io, (y, x));
        atomic.
    landmarks
        (68, 2) px, 0-based; NaN rows are missing points.

    Raises
    ------
    ValueError
        If the suffix is unknown or ``landmarks`` is not (68, 2), holds infinity or nothing but NaN.
    OSError
        If the path cannot be written.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> points = np.arange(136.0).reshape(68, 2)
    >>> tg.write_landmarks("face.pts", points)
    >>> bool((tg.read_landmarks("face.pts") == points).all())
    True
    """
    points = landmark_array(landmarks)
    suffix = file_name(path).suffix.lower()
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
        content = _json({"landmarks": [None if x != x else [x, y] for x, y in points.tolist()]})
    elif suffix == ".ljson":
        content = _json(_ljson(points))
    else:
        raise ValueError(f"path: expected .pts, .npy, .csv, .txt, .json or .ljson, got {path}")
    atomic_write({path: content})


def _lines(points: NDArray[np.float64], separator: str, shift: int) -> str:
    return "\n".join(separator.join(_text(value, shift) for value in row) for row in points.tolist())


def _text(value: float, shift: int) -> str:
    """Shortest decimal that names this float, moved by ``shift`` without rounding."""
    return str(EXACT.add(Decimal(repr(value)), shift)).lower() if shift else repr(value)


def _json(document: dict[str, Any]) -> bytes:
    return f"{json.dumps(document, allow_nan=False)}\n".encode()


def _ljson(points: NDArray[np.float64]) -> dict[str, Any]:
    """Points of pictures stand as (y, x) there; a label masks the points of a part."""
    rows = [[None, None] if x != x else [y, x] for x, y in points.tolist()]
    parts = np.array(frontal_layout().parts)
    labels = [{"label": part, "mask": np.flatnonzero(parts == part).tolist()} for part in dict.fromkeys(parts.tolist())]
    return {"version": 2, "labels": labels, "landmarks": {"points": rows, "connectivity": []}}
