"""Overlapping pairs of axis-aligned boxes: the broad phase of collision tests."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

__all__ = ["box_pairs"]

# Pairs of tree nodes looked at together; bounds the memory also where everything overlaps everything.
_CHUNK = 1 << 19


def box_pairs(
    low: NDArray[np.float64], high: NDArray[np.float64]
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Yield all pairs ``i != j`` (once each, in no order) of closed boxes (3, m) that overlap, in chunks.

    A balanced tree by median splits along the longest axis, walked against itself a level at a time.
    """
    order = _tree_order(low + high)
    padding = order < 0
    lows = [np.where(padding, np.inf, low[:, order])]
    highs = [np.where(padding, -np.inf, high[:, order])]
    while lows[0].shape[1] > 1:
        lows.insert(0, np.minimum(lows[0][:, ::2], lows[0][:, 1::2]))
        highs.insert(0, np.maximum(highs[0][:, ::2], highs[0][:, 1::2]))

    root = np.zeros(1, dtype=np.int64)
    stack = [(0, root, root)]
    while stack:
        level, a, b = stack.pop()
        if len(a) > _CHUNK:
            half = len(a) // 2
            stack += [(level, a[:half], b[:half]), (level, a[half:], b[half:])]
        elif level + 1 < len(lows):
            stack.append((level + 1, *_children(a, b, lows[level + 1], highs[level + 1])))
        else:
            different = a != b
            yield order[a[different]], order[b[different]]


def _tree_order(centres: NDArray[np.float64]) -> NDArray[np.int64]:
    """Indices (2^depth,) of the leaves from left to right; -1 pads."""
    m = centres.shape[1]
    size = 1 << (m - 1).bit_length()
    order = np.full(size, -1)
    order[:m] = np.arange(m)
    while size > 1:
        groups = order.reshape(-1, size)
        points = np.where(groups < 0, np.nan, centres[:, groups])
        extent = np.fmax.reduce(points, axis=2) - np.fmin.reduce(points, axis=2)
        axis = np.where(np.isnan(extent), -1.0, extent).argmax(axis=0)
        # NaN sorts last, so the padding gathers at the right of each group.
        by_axis = np.argsort(points[axis, np.arange(len(groups))], axis=1, kind="stable")
        order = np.take_along_axis(groups, by_axis, axis=1).ravel()
        size //= 2
    return order


def _children(
    a: NDArray[np.int64], b: NDArray[np.int64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Overlapping pairs of the children of node pairs with a <= b."""
    own = a == b
    pairs = [(2 * a, 2 * b), (2 * a, 2 * b + 1), (2 * a + 1, 2 * b + 1)]
    pairs.append((2 * a[~own] + 1, 2 * b[~own]))  # of a node with itself this is the second again
    left = np.concatenate([pair[0] for pair in pairs])
    right = np.concatenate([pair[1] for pair in pairs])
    for k in range(3):  # axis by axis: most pairs are gone after the first
        overlap = (low[k, left] <= high[k, right]) & (low[k, right] <= high[k, left])
        left, right = left[overlap], right[overlap]
    return left, right
