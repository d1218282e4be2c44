"""CSV files of Live Link Face, and other tables of weights."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from toongeo.arrays import Floats
from toongeo.driving.table.cells import read_table
from toongeo.driving.table.expression_columns import expression_columns
from toongeo.driving.table.times import frame_times
from toongeo.driving.table.unit_weights import unit_weights
from toongeo.driving.take import Take
from toongeo.model.expression_schemes import EXPRESSIONS, SCHEMES
from toongeo.reading.promise import promised

__all__ = ["read_live_link", "scheme_matrix"]

_Gaps = Literal["interpolate", "hold"]
_FROM = {"interpolate": "around", "hold": "before"}
_HEAD = ("HeadYaw", "HeadPitch", "HeadRoll")
_TURN = 2 * np.pi  # no head turns so far: larger angles are degrees


@promised("a table of weights")
def read_live_link(path: str | os.PathLike[str], *, fps: float | None = None, gaps: _Gaps = "interpolate") -> Take:
    """A take that the app Live Link Face has recorded, or another table of weights.

    Parameters
    ----------
    path
        A CSV file with a heading; parted by commas, semicolons, tabs or bars, with a point or a comma before decimals.
        Any of the 52 expressions of ARKit or of our own, in any order, as programs write them (``eyeBlink_L``,
        ``jaw_open``); those that are not there are 0. Times are in a column ``Timecode``, ``time`` (time codes, or s),
        ``time_ms`` or ``frame``, if there is one; steps that are too long for seconds are ms, us or ns. Turns of the
        head are radians, or degrees if they are too large for these.
    fps : float, optional
        Frames a second that the last part of a time code counts (23.976 too), or of a file without times. None: the
        rate that the time codes show, or 60.
    gaps : {"interpolate", "hold"}
        Numbers that are missing are drawn from the frames around, or are those of the frame before.

    Returns
    -------
    Take
        A frame that is there twice counts once. ``notes`` says what was filled and left out.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If no column is an expression or one is twice there, a line has another number of cells, a cell is no number,
        or times go back; says which line and column.

    Examples
    --------
    >>> from pathlib import Path
    >>> from toongeo.driving import read_live_link
    >>> size = Path("take.csv").write_text("time,jawOpen\\n0.0,0.0\\n0.5,1.0\\n")
    >>> take = read_live_link("take.csv")
    >>> take.weights.shape, take.seconds
    ((2, 54), 0.5)
    """
    if gaps not in get_args(_Gaps):
        raise ValueError(f"gaps: expected 'interpolate' or 'hold', got {gaps!r}")
    table = read_table(Path(path))
    columns, notes = expression_columns(table)
    times, clock = frame_times(table, fps)
    kept = np.r_[True, np.diff(times) > 0]
    repeated = len(kept) - kept.sum()
    values = {name: table.numbers(column)[kept] for name, column in columns.items()}
    missing = np.any([np.isnan(values[name]) for name in values], axis=0)
    times = times[kept]
    filled = {name: _filled(times, column, f"{path}: column {name}", gaps) for name, column in values.items()}
    weights = np.zeros((len(times), len(EXPRESSIONS)))
    for name, column in filled.items():
        for own, share in SCHEMES["live_link"].get(name, {name: 1.0}).items():
            weights[:, EXPRESSIONS.index(own)] = share * column
    weights, unit = unit_weights(weights, str(path))
    head = np.column_stack([filled[name] for name in _HEAD]) if set(_HEAD) <= set(filled) else None
    if head is not None and np.abs(head).max() > _TURN:
        head = np.radians(head)
        unit += (f"turns of the head of up to {np.degrees(np.abs(head).max()):.4g} were taken for degrees",)
    if repeated:
        notes += (f"{repeated} frames with the time of the one before were left out",)
    if missing.any():
        notes += (f"{missing.sum()} of {len(times)} frames have gaps, which were filled from the frames {_FROM[gaps]}",)
    return Take(times - times[0], weights, head, (*table.notes, *clock, *notes, *unit))


def scheme_matrix(scheme: str, names: Sequence[str]) -> Floats:
    """(len(names), 54): what a weight of 1 under each name of a scheme gives to each of our expressions."""
    matrix = np.zeros((len(names), len(EXPRESSIONS)))
    for row, name in zip(matrix, names, strict=True):
        for own, weight in SCHEMES[scheme][name].items():
            row[EXPRESSIONS.index(own)] = weight
    return matrix


def _filled(times: Floats, values: Floats, what: str, gaps: _Gaps) -> Floats:
    """Numbers without gaps: linear in between or the last one, the nearest beyond."""
    known = np.isfinite(values)
    if not known.any():
        raise ValueError(f"{what}: expected a number in at least one frame, got none")
    if gaps == "hold":
        last = np.maximum.accumulate(np.where(known, np.arange(len(known)), known.argmax()))
        return np.asarray(values[last])
    return np.interp(times, times[known], values[known])
