"""Records that a run makes anew."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from toongeo.app.bench.results.record import Record

__all__ = ["update_records"]


def update_records(records: Sequence[Record], printed: str, origin: Mapping[str, str]) -> list[Record]:
    """The records of one command after it has run.

    A table that was printed takes the place of the record with the same first line; of several with the same first
    line, each the place of its turn. If none has it, the first record becomes all that was printed, and the others stay
    as they are, with their dates.

    Examples
    --------
    >>> old = [Record(name, "x", "2026-01-01", "", "", "", body) for name, body in (("a", "| A |"), ("b", "| B |"))]
    >>> [record.body for record in update_records(old, "| B |\\n|---|\\n| 1 |", {"date": "2026-02-02"})]
    ['| A |', '| B |\\n|---|\\n| 1 |']
    """
    tables: dict[str, list[str]] = {}
    lines: list[str] = []
    for line in [*printed.splitlines(), ""]:
        if line.startswith("|"):
            lines.append(line)
        elif lines:
            tables.setdefault(lines[0], []).append("\n".join(lines))
            lines = []
    updated = []
    for record in records:
        turn = tables.get(record.body.split("\n")[0])
        updated.append(replace(record, body=turn.pop(0), **origin) if turn else record)
    if all(new is old for new, old in zip(updated, records, strict=True)) and printed:
        body = printed if tables else f"```\n{printed}\n```"
        updated[0] = replace(updated[0], body=body, **origin)
    return updated
