"""Which column of a table is which expression."""

from __future__ import annotations

import difflib
from collections.abc import Mapping

from toongeo.driving.table.cells import Table, heading_key
from toongeo.driving.table.expression_key import expression_key
from toongeo.driving.table.times import TIME_COLUMNS
from toongeo.model.expression_schemes import EXPRESSIONS, SCHEMES

__all__ = ["expression_columns"]

_COUNT = "blendshapecount"  # tells nothing that the heading does not, and programs write 51, 52 or 61 alike


def expression_columns(table: Table) -> tuple[dict[str, int], tuple[str, ...]]:
    """Name in the heading's scheme -> column; and notes on what is left out.

    Names are those of Live Link Face, which are ARKit's in capitals, or ours, in any of the ways of
    :func:`expression_key`.

    Raises
    ------
    ValueError
        If no column is an expression, or one is there twice.
    """
    known = {expression_key(name): name for name in (*EXPRESSIONS, *SCHEMES["live_link"])}
    columns: dict[str, int] = {}
    strange = []
    for index, cell in enumerate(table.heading):
        name = known.get(expression_key(cell))
        if name in columns:
            raise ValueError(f"{table.path}: column {cell!r} is there twice")
        if name is not None:
            columns[name] = index
        elif heading_key(cell) not in (_COUNT, *TIME_COLUMNS):
            near = difflib.get_close_matches(expression_key(cell), known, n=1)
            strange.append(f"{cell!r}" + (f" (did you mean {known[near[0]]}?)" if near else ""))
    if not any(SCHEMES["live_link"].get(name, True) for name in columns):
        raise ValueError(
            f"{table.path}: expected columns named like ARKit's expressions, got {', '.join(table.heading[:5])} ..."
        )
    notes = [f"columns that are no expression were left out: {', '.join(strange)}"] if strange else []
    missing = [name for name, own in SCHEMES["live_link"].items() if own and not _given(name, own, columns)]
    if missing:
        some = ", ".join(missing[:3]) + (" ..." if len(missing) > 3 else "")
        notes.append(f"{len(missing)} of 52 expressions have no column and stay 0: {some}")
    return columns, tuple(notes)


def _given(name: str, own: Mapping[str, float], columns: Mapping[str, int]) -> bool:
    return name in columns or any(expression in columns for expression in own)
