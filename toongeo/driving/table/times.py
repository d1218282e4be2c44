"""When the frames of a table were."""

from __future__ import annotations

import re

import numpy as np

from toongeo.arrays import Floats
from toongeo.driving.table.cells import Table

__all__ = ["TIME_COLUMNS", "frame_times"]

_CODES = ("timecode", "time", "timestamp", "seconds", "time_s", "t")
_MILLISECONDS = ("time_ms", "milliseconds", "ms")
_FRAMES = ("frame", "frame_number")
TIME_COLUMNS = (*_CODES, *_MILLISECONDS, *_FRAMES)
_RATES = (24, 25, 30, 48, 50, 60, 100, 120, 240, 1000)  # of cameras; and hundredths and thousandths of a second
_USUAL_RATE = 60.0  # of Live Link Face
_CODE = re.compile(r"(\d+):(\d+):(\d+)(?:[:;](\d+(?:[.,]\d+)?)|([.,]\d+))?")
_DAY = 24 * 3600.0  # s; time codes begin again at midnight
_REPEATED = 0.1  # of the frames: more are no accident, the codes are too coarse


def frame_times(table: Table, fps: float | None = None) -> Floats:
    """Seconds (f,) from the first frame; equal to the one before where a frame is there twice.

    A column of time codes, seconds, milliseconds or frame numbers tells; without one, frames come at a steady rate.

    Parameters
    ----------
    table : Table
    fps : float, optional
        Frames a second. None: the least usual rate that has room for all frames of a second, or 60.

    Raises
    ------
    ValueError
        If a cell is no time, or times go back or mostly stand still; says in which line.
    """
    if fps is not None and not (np.isfinite(fps) and fps > 0):
        raise ValueError(f"fps: expected a rate > 0, got {fps!r}")
    column = table.column(*_CODES)
    if column is not None:
        times = _of_codes(table, column, fps)
    elif (column := table.column(*_MILLISECONDS)) is not None:
        times = _numbers(table, column) / 1000
    elif (column := table.column(*_FRAMES)) is not None:
        times = _numbers(table, column) / (fps or _USUAL_RATE)
    else:
        return np.arange(len(table.rows)) / (fps or _USUAL_RATE)
    times = times - times[0]
    name, steps = table.heading[column], np.diff(times)
    wrong = np.flatnonzero(steps < 0) if (steps == 0).sum() <= _REPEATED * len(times) else np.flatnonzero(steps <= 0)
    if len(wrong):
        where, got = f"{table.path}, line {table.lines[wrong[0] + 1]}", table.rows[wrong[0] + 1][column]
        raise ValueError(f"{where}: expected a {name} after the one before, got {got!r}")
    return times


def _numbers(table: Table, column: int) -> Floats:
    times = table.numbers(column)
    lost = np.flatnonzero(np.isnan(times))
    if len(lost):
        raise ValueError(
            f"{table.path}, line {table.lines[lost[0]]}: expected a number in column {table.heading[column]}, got none"
        )
    return times


def _of_codes(table: Table, column: int, fps: float | None) -> Floats:
    """Seconds of HH:MM:SS:FF.f, HH:MM:SS.f, or plain seconds."""
    cells = [row[column].strip() for row in table.rows]
    if not any(":" in cell for cell in cells):
        return _numbers(table, column)
    parts = np.zeros((len(cells), 4))
    for frame, cell in enumerate(cells):
        match = _CODE.fullmatch(cell)
        if match is None or any(len(part or "") > 6 for part in match.groups()[:3]):
            where = f"{table.path}, line {table.lines[frame]}"
            raise ValueError(f"{where}: expected HH:MM:SS:FF.f in column {table.heading[column]}, got {cell!r}")
        hours, minutes, seconds, frames, fraction = match.groups()
        parts[frame] = [float((part or "0").replace(",", ".")) for part in (hours, minutes, seconds, frames)]
        parts[frame, 2] += float((fraction or "0").replace(",", "."))
    whole, frames = parts[:, :3] @ [3600.0, 60.0, 1.0], parts[:, 3]
    times = whole + frames / (fps or _rate(whole, frames))
    midnights = np.r_[0, np.cumsum(np.diff(times) < -_DAY / 2)]
    return times + _DAY * midnights


def _rate(seconds: Floats, frames: Floats) -> float:
    """The least usual rate that has room for all frames of a second, if the last frame of one was seen."""
    if np.ptp(seconds) == 0 and frames.max() < _USUAL_RATE:
        return _USUAL_RATE
    return float(next((rate for rate in _RATES if rate > frames.max()), _RATES[-1]))
