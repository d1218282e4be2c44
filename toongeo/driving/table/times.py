"""When the frames of a table were."""

from __future__ import annotations

import re

import numpy as np

from toongeo.arrays import Floats
from toongeo.driving.table.cells import Table

__all__ = ["TIME_COLUMNS", "frame_times"]

_CODES = ("timecode", "time", "timestamp", "seconds", "time_s", "timestamp_s", "time_seconds", "t")
_MILLISECONDS = ("time_ms", "timestamp_ms", "time_milliseconds", "milliseconds", "ms")
_FRAMES = ("frame", "frame_number")
TIME_COLUMNS = (*_CODES, *_MILLISECONDS, *_FRAMES)
_RATES = (24, 25, 30, 48, 50, 60, 100, 120, 240, 1000)  # of cameras; and hundredths and thousandths of a second
_USUAL_RATE = 60.0  # of Live Link Face
_NTSC = 1.001  # nominal rates of American television (24, 30, 60) over the true ones (23.976, 29.97, 59.94)
_DROPPED = 2 / 30  # labels of the nominal rate that drop-frame codes leave out a minute, but each tenth
_UNITS = (1.0, 1e3, 1e6, 1e9)  # a second in those of clocks: s, ms, us, ns
_LONGEST_STEP = 4.0  # s from frame to frame: ms of cameras of up to 240 frames a second are more
_CODE = re.compile(r"(\d+):(\d+):(\d+)(?:([:;])(\d+(?:[.,]\d+)?)|([.,]\d+))?")
_DAY = 24 * 3600.0  # s; time codes begin again at midnight
_REPEATED = 0.1  # of the frames: more are no accident, the codes are too coarse


def frame_times(table: Table, fps: float | None = None) -> tuple[Floats, tuple[str, ...]]:
    """Seconds (f,) from the first frame; equal to the one before where a frame is there twice. And notes.

    A column of time codes, seconds, milliseconds or frame numbers tells; without one, frames come at a steady rate.
    Steps that are too long for seconds are of a clock that counts ms, us or ns. Codes with a last ``;`` are drop-frame
    (SMPTE 12M): they leave out labels, so that they keep with the clock at 29.97 or 59.94 frames a second. Codes of
    23.976 (``fps``) do not: a second of theirs lasts 1.001 s.

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
    notes: tuple[str, ...] = ()
    column = table.column(*_CODES)
    if column is not None:
        times, notes = _of_codes(table, column, fps)
    elif (column := table.column(*_MILLISECONDS)) is not None:
        times = _numbers(table, column) / 1000
    elif (column := table.column(*_FRAMES)) is not None:
        times = _numbers(table, column) / (fps or _USUAL_RATE)
    else:
        return np.arange(len(table.rows)) / (fps or _USUAL_RATE), ()
    times = times - times[0]
    name, steps = table.heading[column], np.diff(times)
    wrong = np.flatnonzero(steps < 0) if (steps == 0).sum() <= _REPEATED * len(times) else np.flatnonzero(steps <= 0)
    if len(wrong):
        where, got = f"{table.path}, line {table.lines[wrong[0] + 1]}", table.rows[wrong[0] + 1][column]
        raise ValueError(f"{where}: expected a {name} after the one before, got {got!r}")
    return times, notes


def _numbers(table: Table, column: int) -> Floats:
    times = table.numbers(column)
    lost = np.flatnonzero(np.isnan(times))
    if len(lost):
        raise ValueError(
            f"{table.path}, line {table.lines[lost[0]]}: expected a number in column {table.heading[column]}, got none"
        )
    return times


def _of_codes(table: Table, column: int, fps: float | None) -> tuple[Floats, tuple[str, ...]]:
    """Seconds of HH:MM:SS:FF.f, HH:MM:SS;FF, HH:MM:SS.f, or a plain number of a clock."""
    cells = [row[column].strip() for row in table.rows]
    if not any(":" in cell for cell in cells):
        return _of_clock(_numbers(table, column), table.heading[column])
    parts, marks = np.zeros((len(cells), 4)), set()
    for frame, cell in enumerate(cells):
        match = _CODE.fullmatch(cell)
        if match is None or any(len(part or "") > 6 for part in match.group(1, 2, 3)):
            where = f"{table.path}, line {table.lines[frame]}"
            raise ValueError(f"{where}: expected HH:MM:SS:FF.f in column {table.heading[column]}, got {cell!r}")
        hours, minutes, seconds, mark, frames, fraction = match.groups()
        parts[frame] = [float((part or "0").replace(",", ".")) for part in (hours, minutes, seconds, frames)]
        parts[frame, 2] += float((fraction or "0").replace(",", "."))
        marks.add(mark)
    whole, frames = parts[:, :3] @ [3600.0, 60.0, 1.0], parts[:, 3]
    whole = whole + _DAY * np.r_[0, np.cumsum(np.diff(whole) < -_DAY / 2)]
    return (whole if marks == {None} else _of_labels(whole, frames, fps, drop=";" in marks)), ()


def _of_labels(whole: Floats, frames: Floats, fps: float | None, *, drop: bool) -> Floats:
    """Seconds of codes that count frames: their labels, but those left out, over the true rate."""
    rate = fps or _rate(whole, frames)
    nominal: float = round(rate * _NTSC)
    if rate == round(rate) or not np.isclose(nominal, rate * _NTSC, rtol=1e-5):
        nominal = rate
    if not drop:
        return (whole * nominal + frames) / rate
    minutes = whole // 60
    return (whole * nominal + frames - _DROPPED * nominal * (minutes - minutes // 10)) * _NTSC / nominal


def _of_clock(times: Floats, name: str) -> tuple[Floats, tuple[str, ...]]:
    """Seconds of numbers that may be seconds or parts of them."""
    steps = np.diff(times)
    step = float(np.median(steps[steps > 0])) if len(times) > 2 and (steps > 0).any() else 0.0
    unit = next((unit for unit in _UNITS if step / unit < _LONGEST_STEP), _UNITS[0])
    if unit == 1:
        return times, ()
    return (times - times[0]) / unit, (f"steps of {step:.6g} in column {name} were taken for 1/{unit:.0f} s",)


def _rate(seconds: Floats, frames: Floats) -> float:
    """The least usual rate that has room for all frames of a second, if the last frame of one was seen."""
    if np.ptp(seconds) == 0 and frames.max() < _USUAL_RATE:
        return _USUAL_RATE
    return float(next((rate for rate in _RATES if rate > frames.max()), _RATES[-1]))
