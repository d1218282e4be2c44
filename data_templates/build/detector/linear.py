"""Linear algebra of the training: principal axes and ridge regression, rounded as the file keeps them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from toongeo.pipeline.landmarks.search.detector_file import packed_axes, unpacked_axes

__all__ = ["principal_axes", "ridge_weights", "rounded", "signed"]

_RIDGES = (0.03, 0.1, 0.3, 1.0)  # of the mean of the diagonal; the best on held-out renders is taken


def rounded(array: NDArray) -> NDArray[np.float32]:
    """To half precision, so that training goes on with what the file holds."""
    return array.astype(np.float16).astype(np.float32)


def signed(axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Axes (d, k) with their largest component positive: eigenvectors have no sign of their own."""
    largest = np.abs(axes).argmax(axis=0)
    return axes * np.sign(axes[largest, np.arange(axes.shape[1])])


def principal_axes(described: NDArray[np.float32], count: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Mean (k, d) and first principal axes (k, d, count) of descriptors (n, k, d), point by point."""
    _, points, size = described.shape
    mean, axes = np.empty((points, size)), np.empty((points, size, count))
    for j in range(points):
        mean[j] = described[:, j].mean(axis=0)
        centred = described[:, j].astype(np.float64) - mean[j]
        _, vectors = np.linalg.eigh(centred.T @ centred)
        axes[j] = signed(vectors[:, ::-1][:, :count])
    return rounded(mean), unpacked_axes(*packed_axes(axes.astype(np.float32)))


def ridge_weights(
    rows: NDArray[np.float32], aims: NDArray[np.float32], test_rows: NDArray[np.float32], test_aims: NDArray[np.float32]
) -> tuple[NDArray[np.float32], float]:
    """Weights (d, 2 k) of the regression of steps (n, 2 k) on rows (n, d), and the ridge that tests best."""
    gram, sides = rows.T @ rows, rows.T @ aims
    best, unit = (np.inf, np.zeros(0, np.float32), 0.0), np.trace(gram) / len(gram)
    for ridge in _RIDGES:
        normal = gram.astype(np.float64)
        normal[np.diag_indices_from(normal)] += ridge * unit
        weights = cho_solve(cho_factor(normal, overwrite_a=True), sides.astype(np.float64)).astype(np.float32)
        left = (test_aims - test_rows @ weights).reshape(len(test_rows), -1, 2)
        error = float(np.linalg.norm(left, axis=2).mean())
        if error < best[0]:
            best = error, weights, ridge
    return rounded(best[1]), best[2]
