"""Principal components of a set of shapes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.one_thread import one_thread

__all__ = ["principal_modes"]

_LEAST_SHARE = 1e-4  # of the variance: what is below it is rounding of the files


def principal_modes(shapes: NDArray[np.float64], most: int = 200) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    """Mean (n, 3) and modes (k, n, 3) of shapes (s, n, 3): a unit of a mode is one standard deviation.

    Each mode's sign is such that its largest number is positive.

    Examples
    --------
    >>> shapes = np.array([[[0.0, 0, 0]], [[2, 0, 0]]])
    >>> principal_modes(shapes)[1].round(3)
    array([[[1.414, 0.   , 0.   ]]], dtype=float32)
    """
    mean = shapes.mean(axis=0)
    flat = (shapes - mean).reshape(len(shapes), -1)
    with one_thread():
        values, vectors = np.linalg.eigh(flat @ flat.T / max(len(shapes) - 1, 1))
        order = np.argsort(values)[::-1]
        kept = order[values[order] > _LEAST_SHARE * max(values.max(initial=0), 0)][:most]
        # v = X^T u / |X^T u|, times the root of its variance
        modes = vectors[:, kept].T @ flat / np.sqrt(max(len(shapes) - 1, 1))
    signs = np.sign(modes[np.arange(len(modes)), np.abs(modes).argmax(axis=1)]) if len(modes) else np.zeros(0)
    return mean, np.ascontiguousarray((signs[:, None] * modes).reshape(-1, *mean.shape), np.float32)
