"""Texts and records as one file."""

from __future__ import annotations

import re
from collections.abc import Mapping

from toongeo.app.bench.results.record import Record

__all__ = ["assemble_results"]


def assemble_results(sections: Mapping[str, str], records: Mapping[str, Record]) -> str:
    """The file of results: the sections in their order, with the records that they name.

    Raises
    ------
    ValueError
        If a text names a record that is not there, or one is named by none.
    """
    named: set[str] = set()

    def record(match: re.Match[str]) -> str:
        if match[1] not in records:
            raise ValueError(f"records: expected one called {match[1]}, which a text names")
        named.add(match[1])
        return records[match[1]].shown()

    text = "\n\n".join(re.sub(r"^\{\{(\S+)\}\}$", record, body, flags=re.MULTILINE) for body in sections.values())
    if forgotten := sorted(set(records) - named):
        raise ValueError(f"sections: expected {', '.join(forgotten)} to be named by a text")
    return text + "\n"
