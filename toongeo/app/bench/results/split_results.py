"""The file of results taken apart: texts here, tables there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

__all__ = ["SplitTable", "split_results"]

_COMMAND = re.compile(r"`((?:[A-Z_]+=\S+ )*(?:python benchmarks/|toongeo bench )[^`]*)`")
_MARK = re.compile(r"<!-- record: (\S+) -->")
_ORIGIN = "<sub>Recorded "


@dataclass(frozen=True)
class SplitTable:
    """A table of the results: its name, the command that the text names last before it, its first line, and itself."""

    name: str
    command: str
    line: int
    body: str


def split_results(text: str) -> tuple[dict[str, str], list[SplitTable]]:
    """Sections by name, in their order, with ``{{name}}`` in the place of each table; and the tables.

    A file that :func:`assemble_results` put together comes apart into what it was made of.
    """
    sections: dict[str, list[str]] = {}
    tables: list[SplitTable] = []
    slug, command, count = "head", "", 0
    for number, block in _blocks(text.splitlines()):
        first = block[0]
        if first.startswith("## "):
            slug, command, count = re.sub(r"[^a-z0-9]+", "-", first[3:].lower()).strip("-"), "", 0
        lines = sections.setdefault(slug, [])
        if first.startswith(_ORIGIN):
            if lines and not lines[-1]:
                lines.pop()  # the empty line that came with it
            continue
        mark = _MARK.match(first)
        if not mark and not _is_table(block):
            command = ([command] + _COMMAND.findall("\n".join(block)))[-1]
            lines.extend(block)
            continue
        count += 1
        name = mark[1] if mark else f"{slug}-{count}"
        while name in {table.name for table in tables}:
            count += 1
            name = f"{slug}-{count}"
        body = block[1:] if mark else block
        tables.append(SplitTable(name, command, number + (len(block) - len(body)), "\n".join(body)))
        lines.append("{{" + name + "}}")
    return {slug: "\n".join(lines).strip("\n") for slug, lines in sections.items()}, tables


def _is_table(block: list[str]) -> bool:
    return len(block) > 1 and block[0].startswith("|") and set(block[1]) <= set("|-: ")


def _blocks(lines: list[str]) -> Iterator[tuple[int, list[str]]]:
    """Line number from 1, and lines that belong together: a table, a record with its mark, or a single line."""
    k = 0
    while k < len(lines):
        stop = k + 1
        if _MARK.match(lines[k]):  # up to the line that tells the origin
            while stop < len(lines) and not lines[stop].startswith(_ORIGIN):
                stop += 1
            block = lines[k:stop]
            while block and not block[-1]:
                block.pop()
        else:
            if lines[k].startswith("|"):
                while stop < len(lines) and lines[stop].startswith("|"):
                    stop += 1
            block = lines[k:stop]
        yield k + 1, block
        k = stop
