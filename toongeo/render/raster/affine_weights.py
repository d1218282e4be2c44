"""Barycentric coordinates as functions of the pixel."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats, Integers

__all__ = ["affine_weights"]


def affine_weights(points: Floats, faces: Integers) -> tuple[Floats, Floats]:
    """Six numbers a face: the weights of its corners 1 and 2 are affine in the pixel, gx x + gy y + g0.

    Also twice the signed area (m,), negative for a face that runs counter-clockwise as seen (y is down).
    """
    x, y = np.ascontiguousarray(points[:, :2].T)
    a, b, c = faces.T
    ax, ay = x[a], y[a]
    ux, uy, vx, vy = x[b] - ax, y[b] - ay, x[c] - ax, y[c] - ay
    twice_area = ux * vy - uy * vx
    inverse = 1.0 / np.where(twice_area == 0.0, np.inf, twice_area)
    gx1, gy1, gx2, gy2 = vy * inverse, -vx * inverse, -uy * inverse, ux * inverse
    constants = -(gx1 * ax + gy1 * ay), -(gx2 * ax + gy2 * ay)
    return np.column_stack([gx1, gy1, constants[0], gx2, gy2, constants[1]]), twice_area
