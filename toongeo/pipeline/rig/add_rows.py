"""A weighted sum of blendshapes, of which most have no weight."""

import numpy as np
from scipy.linalg.blas import saxpy

from toongeo.geometry.one_thread import one_thread

__all__ = ["add_rows"]

_MANY = 0.6  # share of rows from which one product over all of them is faster than adding those that have weight


def add_rows(total: np.ndarray, rows: np.ndarray, weights: np.ndarray) -> None:
    """Add ``weights @ rows`` to ``total``, in place; only rows with a weight are read, unless those are many.

    Parameters
    ----------
    total : (c,) float32
        Changed.
    rows : (k, c) float32, contiguous
    weights : (k,) float

    Examples
    --------
    >>> total = np.ones(2, np.float32)
    >>> add_rows(total, np.array([[1, 2], [3, 4]], np.float32), np.array([0.0, 2.0]))
    >>> total
    array([7., 9.], dtype=float32)
    """
    active = np.flatnonzero(weights)
    if len(active) > _MANY * len(rows):
        span = slice(active[0], active[-1] + 1)
        with one_thread():
            total += weights[span].astype(np.float32) @ rows[span]
        return
    for row in active:
        saxpy(rows[row], total, a=weights[row])
