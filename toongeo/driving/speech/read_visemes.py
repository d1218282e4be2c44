"""Timings of visemes from files of other programs."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from toongeo.driving.speech.viseme_table import AZURE, RHUBARB, oculus_viseme
from toongeo.driving.speech.viseme_track import VisemeTrack
from toongeo.reading.decoded import decoded
from toongeo.reading.promise import promised

__all__ = ["read_visemes"]

_TICK = 1e-7  # s: Azure counts in hundreds of nanoseconds
_LAST = 0.1  # s that a viseme lasts of which only the beginning is told, and no other follows
_Row = tuple[float, float | None, str]  # start, end if it is told, viseme


@promised("timings of visemes")
def read_visemes(path: str | os.PathLike[str]) -> VisemeTrack:
    """Which viseme is spoken when, as lip-sync programs and speech services tell it.

    Parameters
    ----------
    path
        ==================================  =================================================================
        Rhubarb Lip Sync, ``.json``         ``{"mouthCues": [{"start": 0.0, "end": 0.1, "value": "A"}, ...]}``
        Rhubarb Lip Sync, ``.tsv``          lines of a time in s and a letter
        TalkingHead, ``.json``              ``{"visemes": ["aa"], "vtimes": [0], "vdurations": [100]}``, in ms
        Azure's viseme events, ``.json``    ``[{"audioOffset": 500000, "visemeId": 1}, ...]``, in 100 ns
        ==================================  =================================================================

        Names of Azure's fields may be written as its other libraries do (``AudioOffset``, ``audio_offset``,
        ``viseme_id``, ``Offset`` ...).

    Returns
    -------
    VisemeTrack

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is none of these, or a number, a name or an order is not what it should be; says which entry.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "hello.tsv"
    >>> _ = path.write_text("0.00\\tX\\n0.25\\tC\\n0.50\\tX\\n")
    >>> read_visemes(path).names
    ('sil', 'E', 'sil')
    """
    path = Path(path)
    text = decoded(path.read_bytes(), "replace")
    try:
        rows = _read_json(text) if text.lstrip()[:1] in ("{", "[") else _read_table(text)
        return _track(rows)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _track(rows: list[_Row]) -> VisemeTrack:
    if not rows:
        raise ValueError("expected visemes, got none")
    starts = np.array([start for start, _, _ in rows])
    following = np.r_[starts[1:], starts[-1] + _LAST]
    ends = [after if end is None else end for (_, end, _), after in zip(rows, following.tolist(), strict=True)]
    return VisemeTrack(tuple(name for _, _, name in rows), starts, np.array(ends))


def _read_table(text: str) -> list[_Row]:
    rows: list[_Row] = []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip():
            continue
        cells = line.split()
        if len(cells) != 2 or cells[1] not in RHUBARB:
            raise ValueError(f"line {number}: expected a time and a letter of {''.join(RHUBARB)}, got {line[:60]!r}")
        rows.append((_number(cells[0], f"line {number}"), None, RHUBARB[cells[1]]))
    return rows


def _read_json(text: str) -> list[_Row]:
    try:
        content = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise ValueError(f"expected JSON, got a file that is none ({error})") from None
    if isinstance(content, dict) and isinstance(content.get("mouthCues"), list):
        return [_cue(entry, f"mouthCues[{k}]") for k, entry in enumerate(content["mouthCues"])]
    if isinstance(content, dict) and isinstance(content.get("vtimes"), list):
        return _talking_head(content)
    if isinstance(content, dict) and "words" in content:
        raise ValueError("expected visemes and vtimes, got words alone: how they sound is not told")
    events = next(iter(content.values())) if isinstance(content, dict) and len(content) == 1 else content
    if isinstance(events, list):
        return [_event(entry, f"event {k}") for k, entry in enumerate(events)]
    raise ValueError("expected mouthCues (Rhubarb), visemes with vtimes (TalkingHead) or a list of events (Azure)")


def _cue(entry: Any, where: str) -> _Row:
    if not isinstance(entry, dict) or entry.get("value") not in RHUBARB:
        raise ValueError(f"{where}: expected start, end and a value of {''.join(RHUBARB)}, got {str(entry)[:60]}")
    return _number(entry.get("start"), where), _number(entry.get("end"), where), RHUBARB[entry["value"]]


def _talking_head(content: dict[str, Any]) -> list[_Row]:
    names, times = content.get("visemes"), content["vtimes"]
    lengths = content.get("vdurations", [None] * len(times))
    if not isinstance(names, list) or not isinstance(lengths, list) or not len(names) == len(times) == len(lengths):
        raise ValueError("visemes, vtimes, vdurations: expected lists of one length")
    rows: list[_Row] = []
    for k, (name, time, length) in enumerate(zip(names, times, lengths, strict=True)):
        start = _number(time, f"vtimes[{k}]") / 1000
        end = None if length is None else start + _number(length, f"vdurations[{k}]") / 1000
        try:
            rows.append((max(start, 0.0), end, oculus_viseme(str(name))))
        except ValueError as error:
            raise ValueError(f"visemes[{k}]: {error}") from None
    return rows


def _event(entry: Any, where: str) -> _Row:
    plain = (
        {str(key).lower().replace("_", ""): value for key, value in entry.items()} if isinstance(entry, dict) else {}
    )
    time = plain.get("audiooffset", plain.get("offset"))
    number = _number(plain.get("visemeid"), where)
    if number not in AZURE:
        raise ValueError(f"{where}: expected audioOffset and a visemeId of 0 to {max(AZURE)}, got {str(entry)[:60]}")
    return _number(time, where) * _TICK, None, AZURE[int(number)]


def _number(value: Any, where: str) -> float:
    try:
        if isinstance(value, (bool, type(None))):
            raise TypeError
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{where}: expected a number, got {value!r}") from None
