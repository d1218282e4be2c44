"""The best smooth way through a picture of strengths."""

import numpy as np

__all__ = ["smooth_path"]

_STEP = 2  # columns a row that the way may turn aside
_PRICE = 0.3  # of each


def smooth_path(strength: np.ndarray) -> np.ndarray:
    """Columns (k,), one a row, whose strengths (k, m) have the largest sum, by dynamic programming.

    From row to row the column changes by at most two, and each column aside costs 0.3.

    Examples
    --------
    >>> smooth_path(np.eye(3))
    array([0, 1, 2])
    """
    rows, columns = strength.shape
    total, back = strength[0].astype(float), np.zeros((rows, columns), int)
    at, steps = np.arange(columns), np.arange(-_STEP, _STEP + 1)
    before = at - steps[:, None]
    inside = (before >= 0) & (before < columns)
    price = np.where(inside, _PRICE * np.abs(steps)[:, None], np.inf)
    before = np.clip(before, 0, columns - 1)
    for row in range(1, rows):
        gains = total[before] - price
        best = gains.argmax(0)
        back[row] = before[best, at]
        total = gains[best, at] + strength[row]
    way = [int(total.argmax())]
    for row in range(rows - 1, 0, -1):
        way.append(int(back[row, way[-1]]))
    return np.array(way[::-1])
