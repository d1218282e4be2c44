"""The cheapest cut of a picture into two sides."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, maximum_flow

from toongeo.arrays import Mask, Singles

__all__ = ["min_cut"]


_UNITS = 20  # capacities are integers: steps of a twentieth
# Half of the eight neighbours, and what an edge to them weighs.
_NEIGHBOURS = (((0, 1), 1.0), ((1, 0), 1.0), ((1, 1), 0.7), ((1, -1), 0.7))


def min_cut(odds: Singles, lab: Singles, smoothness: float, sure: float) -> Mask:
    """Inside (h, w) bool that minimises the odds it goes against plus the borders it draws (Boykov and Jolly 2001).

    Parameters
    ----------
    odds : (h, w) float
        Log-odds of inside.
    lab : (h, w, 3) float
        Colours; borders are cheap where they change.
    smoothness : float
        Cost of a border between equal colours, per pixel.
    sure : float
        Pixels with larger odds, either way, that lie among such pixels only keep their side: this saves most
        of the work.
    """
    height, width = odds.shape
    doubtful = np.abs(odds) < sure
    wide = np.pad(doubtful | _border(odds > 0), 2)
    active = np.zeros_like(doubtful)
    for dy in range(5):
        for dx in range(5):
            active |= wide[dy : dy + height, dx : dx + width]
    side = odds > 0
    count = int(active.sum())
    if count == 0:
        return side
    number = np.full(odds.shape, -1)
    number[active] = np.arange(count)
    terminal = np.rint(odds[active] * _UNITS).astype(np.int64)
    rows, columns, costs = [], [], []
    for one, two, cost in _edges(lab, smoothness):
        cost = cost.ravel()
        a, b = number[one].ravel(), number[two].ravel()
        for here, there in ((a, side[two].ravel()), (b, side[one].ravel())):
            lone = (here >= 0) & ((b if here is a else a) < 0)  # the neighbour's side is settled
            np.add.at(terminal, here[lone], np.where(there[lone], cost[lone], -cost[lone]))
        both = (a >= 0) & (b >= 0)
        rows += [a[both], b[both]]
        columns += [b[both], a[both]]
        costs += [cost[both], cost[both]]
    source, sink = count, count + 1
    inside, outside = np.flatnonzero(terminal > 0), np.flatnonzero(terminal < 0)
    rows += [np.full(len(inside), source), outside]
    columns += [inside, np.full(len(outside), sink)]
    costs += [terminal[inside], -terminal[outside]]
    capacity = np.concatenate(costs).astype(np.int32)
    graph = coo_matrix((capacity, (np.concatenate(rows), np.concatenate(columns))), (count + 2,) * 2).tocsr()
    rest = graph - maximum_flow(graph, source, sink).flow
    rest.data[rest.data < 0] = 0
    rest.eliminate_zeros()
    reached = np.zeros(count + 2, bool)
    reached[breadth_first_order(rest, source, return_predecessors=False)] = True
    result = side.copy()
    result[active] = reached[:count]
    return result


def _edges(lab: Singles, smoothness: float):  # type: ignore[no-untyped-def]
    """Slices of the two ends of all edges in each direction, and their costs."""
    pairs = []
    for (dy, dx), weight in _NEIGHBOURS:
        height, width = lab.shape[:2]
        one = np.s_[: height - dy, max(0, -dx) : width - max(0, dx)]
        two = np.s_[dy:, max(0, dx) : width - max(0, -dx)]
        pairs.append((one, two, weight, np.square(lab[one] - lab[two]).sum(axis=2)))
    spread = 2 * float(np.mean([difference.mean() for *_, difference in pairs])) + 1e-6
    for one, two, weight, difference in pairs:
        cost = smoothness * weight * np.exp(-difference / spread)
        yield one, two, (cost * _UNITS + 1).astype(np.int64)


def _border(mask: Mask) -> Mask:
    """Pixels beside one of the other side."""
    border = np.zeros_like(mask)
    border[:, 1:] |= mask[:, 1:] != mask[:, :-1]
    border[1:] |= mask[1:] != mask[:-1]
    return border
