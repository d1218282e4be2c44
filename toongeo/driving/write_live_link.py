"""Takes as CSV files of Live Link Face."""

from __future__ import annotations

import csv
import io
import os

import numpy as np

from toongeo.arrays import Floats
from toongeo.driving.take import Take
from toongeo.io import atomic_write
from toongeo.model.expression_schemes import EXPRESSIONS, SCHEMES

__all__ = ["write_live_link"]

_HEAD = ("HeadYaw", "HeadPitch", "HeadRoll")
_DAY = 24 * 3600  # s; time codes begin again at midnight


def write_live_link(path: str | os.PathLike[str], take: Take, *, fps: float = 60.0) -> None:
    """Write a take as the app Live Link Face does, with its 61 columns.

    A column that moves two of our expressions, ``BrowInnerUp`` and ``CheekPuff``, gets their mean: this format cannot
    tell them apart. Rotations that are not known are 0.

    Parameters
    ----------
    path
        The file, complete or not there.
    take : Take
    fps : float
        Frames a second that the last part of a time code counts, to the thousandth; not the rate of the take. With 60
        :func:`read_live_link` finds the rate by itself, if the take has six frames a second or more.

    Raises
    ------
    OSError
        If the file cannot be written.
    ValueError
        If the rate is not positive.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from toongeo.driving import read_live_link
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "take.csv"
    >>> write_live_link(path, Take.of_frames(np.full((3, 54), 0.5), 30))
    >>> again = read_live_link(path, fps=60)
    >>> bool((again.weights == 0.5).all()), again.times.round(3).tolist()
    (True, [0.0, 0.033, 0.067])
    """
    if not (np.isfinite(fps) and fps > 0):
        raise ValueError(f"fps: expected a rate > 0, got {fps!r}")
    names = tuple(SCHEMES["live_link"])
    columns = np.column_stack([_column(name, take) for name in names])
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(["Timecode", "BlendShapeCount", *names])
    for time, row in zip(take.times - take.times[0], columns, strict=True):
        writer.writerow([_timecode(float(time), fps), len(names), *(f"{value:.8g}" for value in row)])
    atomic_write({path: text.getvalue().encode()})


def _column(name: str, take: Take) -> Floats:
    if name in _HEAD and take.head is not None:
        return np.asarray(take.head[:, _HEAD.index(name)])
    own = [EXPRESSIONS.index(expression) for expression in SCHEMES["live_link"][name]]
    return take.weights[:, own].mean(axis=1) if own else np.zeros(len(take.times))


def _timecode(time: float, fps: float) -> str:
    """HH:MM:SS:FF.fff of seconds."""
    second = int(time)
    frame = round((time - second) * fps, 3)
    if frame >= fps:  # rounding reached the next second
        second, frame = second + 1, 0.0
    second %= _DAY
    return f"{second // 3600:02d}:{second // 60 % 60:02d}:{second % 60:02d}:{frame:06.3f}"
