"""Smooth displacements of the head, for what the artist's modes do not span.

A Gaussian process over points of space: neighbours move alike, whatever part of the head they belong to, so lips, lids
and eyeballs stay where they belong.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Lengths and standard deviations of the displacements, mm: what registrations with the artist's modes leave over.
SCALES_MM = ((40.0, 1.2), (15.0, 0.6), (8.0, 0.3))
N_FUNCTIONS = 70  # principal ones; three displacements each
N_CENTRES = 400


def smooth_modes(points: Floats, face: Floats, count: int = N_FUNCTIONS) -> Floats:
    """Modes (3 count, n, 3) at points (n, 3) of a process whose principal functions are those on a face (f, 3).

    Its covariance at the face is the sum of ``sd^2 exp(-d^2 / 2 length^2)`` over `SCALES_MM`, for each coordinate, cut
    to its ``count`` largest principal functions (Nystroem's extension elsewhere): off the face it fades to nothing.
    """
    centres = face[farthest_points(face, min(N_CENTRES, len(face)))]
    variances, U = np.linalg.eigh(covariance(centres, centres))
    largest = np.argsort(-variances)[:count]
    functions = covariance(points, centres) @ U[:, largest] / np.sqrt(variances[largest])
    modes = np.zeros((count, 3, len(points), 3))
    for axis in range(3):
        modes[:, axis, :, axis] = functions.T
    return modes.reshape(3 * count, len(points), 3)


def covariance(a: Floats, b: Floats) -> Floats:
    """(n, m) between displacements at points (n, 3) and (m, 3), mm^2."""
    squares = (a**2).sum(axis=1)[:, None] + (b**2).sum(axis=1) - 2 * a @ b.T
    return sum(sd**2 * np.exp(-np.maximum(squares, 0) / (2 * length**2)) for length, sd in SCALES_MM)


def farthest_points(points: Floats, count: int) -> NDArray[np.int64]:
    """Indices of points, each as far as can be from those before it."""
    chosen = [int(np.argmin(((points - points.mean(axis=0)) ** 2).sum(axis=1)))]
    nearest = np.full(len(points), np.inf)
    while len(chosen) < count:
        nearest = np.minimum(nearest, ((points - points[chosen[-1]]) ** 2).sum(axis=1))
        chosen.append(int(nearest.argmax()))
    return np.array(chosen)
