"""The displacements of morph targets, stored where they are not zero."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.io._glb_builder import VERTICES, GlbBuilder


@dataclass
class _Rows:
    """Rows that targets store, and the buffer view of their numbers."""

    mask: NDArray[np.bool_]
    count: int
    view: int


def add_targets(
    builder: GlbBuilder, deltas: NDArray, tolerance: float, *, bounds: bool, normalized: bool = False
) -> list[int]:
    """Accessors of deltas (k, n, 3), of the type they shall have in the file.

    A target stores all rows, or those beyond ``tolerance`` with their numbers, or those of a greater target, whose
    numbers it shares: whichever takes the fewest bytes. Expressions of a face mostly move the same part of the head.
    """
    k, n = deltas.shape[:2]
    moved = (np.abs(deltas) > tolerance).any(axis=2)
    number = np.dtype("<u2" if n <= 65536 else "<u4")
    row = 3 * deltas.itemsize
    dense_row = row + -row % 4
    lists: list[_Rows] = []
    accessors = [0] * k
    for target in np.argsort(-moved.sum(axis=1), kind="stable"):  # the greatest first
        count = int(moved[target].sum())
        if count == 0:  # an accessor without buffer view is all zero (3.6.2.3)
            zero = np.zeros((n, 3), deltas.dtype)
            accessors[target] = builder.add("accessors", **builder.described(zero, bounds, normalized))
            continue
        fitting = [rows for rows in lists if not (moved[target] & ~rows.mask).any()]
        shared = min(fitting, key=lambda rows: rows.count, default=None)
        own_cost = count * (row + number.itemsize)
        shared_cost = np.inf if shared is None else shared.count * row
        if min(own_cost, shared_cost) >= n * dense_row:
            kept = np.where(moved[target, :, None], deltas[target], 0).astype(deltas.dtype)
            accessors[target] = builder.accessor(kept, VERTICES, bounds=bounds, normalized=normalized)
            continue
        if shared is None or own_cost <= shared_cost:
            view = builder.view(np.flatnonzero(moved[target]).astype(number).tobytes())
            shared = _Rows(moved[target], count, view)
            lists.append(shared)
        accessors[target] = _sparse(builder, deltas[target], shared, number, bounds, normalized)
    return accessors


def _sparse(
    builder: GlbBuilder, delta: NDArray, rows: _Rows, number: np.dtype, bounds: bool, normalized: bool
) -> int:
    kept = np.where(rows.mask[:, None], delta, 0).astype(delta.dtype)
    code = builder.described(np.zeros(0, number), False)["componentType"]
    sparse = {
        "count": rows.count,
        "indices": {"bufferView": rows.view, "componentType": code},
        "values": {"bufferView": builder.view(delta[rows.mask].tobytes())},
    }
    return builder.add("accessors", **builder.described(kept, bounds, normalized), sparse=sparse)
