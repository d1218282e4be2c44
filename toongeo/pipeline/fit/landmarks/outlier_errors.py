"""Tells a landmark that is wrong from a part of the face that is drawn wrong."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.model.ibug68 import LID_RIMS, LIP_RIMS, PARTS

__all__ = ["NEIGHBOURS", "outlier_errors"]


def _neighbours() -> NDArray[np.bool_]:
    nose = PARTS["nose"]
    bridge, base = nose[:4], nose[4:]
    chains = [PARTS["jaw"], PARTS["brow_right"], PARTS["brow_left"], bridge, base, nose[[3, 6]]]
    chains += [np.array(rim) for rim in (*LID_RIMS.values(), *LIP_RIMS.values())]
    matrix = np.zeros((68, 68), bool)
    for chain in chains:
        matrix[chain[:-1], chain[1:]] = matrix[chain[1:], chain[:-1]] = True
    matrix.setflags(write=False)
    return matrix


NEIGHBOURS = _neighbours()
"""Which of the 68 points (68, 68) follow each other along the jaw, a brow, the nose, a lid or a lip."""


def outlier_errors(errors: Floats, neighbours: NDArray[np.bool_]) -> Floats:
    """Errors (2, k, 2): of each point, and of each point beside its neighbours; the lesser is what is odd.

    A wrong point lies far from where the face puts it, and far from where its neighbours would move it. An eye
    that is drawn twice as large moves together: each of its points is off by about as much as its neighbours
    are on average.

    Parameters
    ----------
    errors : (k, 2) float
    neighbours : (k, k) bool, symmetric
        A point without any is judged by its own error alone.

    Returns
    -------
    (2, k, 2) float
        The errors, and these less the neighbours' mean.
    """
    count = np.maximum(neighbours.sum(axis=1), 1)[:, None]
    return np.stack([errors, errors - (neighbours @ errors) / count])
