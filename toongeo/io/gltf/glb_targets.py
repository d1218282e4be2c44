"""The displacements of morph targets, stored where they are not zero."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.io.gltf.glb_builder import VERTICES, GlbBuilder

__all__ = ["add_targets"]


@dataclass
class _Rows:
    """Rows that targets store, and the buffer view of their numbers."""

    mask: NDArray[np.bool_]
    count: int
    view: int


def add_targets(
    builder: GlbBuilder,
    deltas: NDArray,
    tolerance: float,
    sparse: bool,
    *,
    bounds: bool = False,
    normalized: bool = False,
) -> list[int]:
    """Accessors of deltas (k, n, 3), of the type they shall have in the file; small 16-bit integers get 8 bits.

    A target stores all rows, or those beyond ``tolerance`` with their numbers, or those of a greater target, whose
    numbers it shares: whichever takes the fewest bytes. Expressions of a face mostly move the same part of the head.
    Without ``sparse`` all store all rows.
    """
    n = deltas.shape[1]
    moved = (np.abs(deltas) > tolerance).any(axis=2)
    number = np.dtype("<u2" if n <= 65536 else "<u4")
    lists: list[_Rows] = []
    accessors = [0] * len(deltas)
    for target in np.argsort(-moved.sum(axis=1), kind="stable"):  # the greatest first
        delta = deltas[target]
        if delta.dtype == np.int16 and np.abs(delta).max() <= 127:
            delta = delta.astype("<i1")
        rows = _rows(builder, moved[target], lists, 3 * delta.itemsize, number) if sparse else None
        stored = moved[target] if rows is None else rows.mask
        kept = np.where(stored[:, None], delta, 0).astype(delta.dtype)
        if rows is None:
            accessors[target] = builder.accessor(kept, VERTICES, bounds=bounds, normalized=normalized)
            continue
        entry = None  # an accessor without buffer view is all zero (3.6.2.3)
        if rows.count:
            indices = {
                "bufferView": rows.view,
                "componentType": builder.described(np.zeros(1, number))["componentType"],
            }
            values = {"bufferView": builder.view(delta[stored].tobytes())}
            entry = {"count": rows.count, "indices": indices, "values": values}
        accessors[target] = builder.add("accessors", **builder.described(kept, bounds, normalized), sparse=entry)
    return accessors


def _rows(
    builder: GlbBuilder, moved: NDArray[np.bool_], lists: list[_Rows], row: int, number: np.dtype
) -> _Rows | None:
    """The rows a target stores, of ``row`` bytes each: its own or a list that is there; None if all are cheaper."""
    count = int(moved.sum())
    if count == 0:
        return _Rows(moved, 0, -1)
    fitting = [rows for rows in lists if not (moved & ~rows.mask).any()]
    shared = min(fitting, key=lambda rows: rows.count, default=None)
    own_cost = count * (row + number.itemsize)
    shared_cost = np.inf if shared is None else shared.count * row
    if min(own_cost, shared_cost) >= len(moved) * (row + -row % 4):
        return None
    if shared is None or own_cost <= shared_cost:
        shared = _Rows(moved, count, builder.view(np.flatnonzero(moved).astype(number).tobytes()))
        lists.append(shared)
    return shared
