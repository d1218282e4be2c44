"""The nearest face of each pixel by a z-buffer in NumPy."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats, Integers, Singles

__all__ = ["z_buffer"]

_CANDIDATES = 2**18  # pixels of bounding boxes at once, unless one face has more: some tens of MB


def z_buffer(
    points: Floats,
    faces: Integers,
    affine: Floats,
    growth: Singles,
    height: int,
    width: int,
) -> NDArray[np.int32]:
    """Row of the nearest face at each pixel, -1 where there is none.

    Of each face the pixels of its bounding box are tried, many faces at once. A face that grows by a part g of its size
    about its centroid covers the pixels where its weights are at least -g/3. Depths are rounded to float32 of their
    range, so that faces which lie on each other are a tie.

    Parameters
    ----------
    points
        (n, 3): x and y in px, and the depth, larger is nearer.
    faces
        (m, 3); at equal depth the lower row wins.
    affine
        (m, 6): the weights of corners 1 and 2 at a pixel are gx x + gy y + g0.
    growth
        (m,) part of its size by which each face grows.
    height, width
        px.

    Returns
    -------
    (height, width) int32

    Examples
    --------
    >>> points, faces = np.array([[0.0, 0, 0], [2, 0, 0], [0, 2, 0]]), np.array([[0, 1, 2]])
    >>> z_buffer(points, faces, np.array([[0.5, 0, 0, 0, 0.5, 0]]), np.zeros(1, np.float32), 2, 3)
    array([[ 0,  0,  0],
           [ 0,  0, -1]], dtype=int32)
    """
    rows = np.full(height * width, -1, np.int32)
    nearest = np.full(height * width, -np.inf, np.float32)
    lowest_weight = growth / np.float32(-3.0)
    planes = _depth_planes(points[:, 2], faces, affine)
    for face, x, y in _candidates(points, faces, growth, height, width):
        gx1, gy1, g01, gx2, gy2, g02 = affine.take(face, axis=0).T
        first, second = gx1 * x + gy1 * y + g01, gx2 * x + gy2 * y + g02
        inside = np.flatnonzero(np.minimum(np.minimum(first, second), 1.0 - first - second) >= lowest_weight[face])
        face, pixel = face[inside], (y * width + x)[inside]
        zx, zy, z0 = planes.take(face, axis=0).T
        depth = (zx * x[inside] + zy * y[inside] + z0).astype(np.float32)
        before = nearest[pixel]
        np.maximum.at(nearest, pixel, depth)
        seen = np.flatnonzero((depth > before) & (depth == nearest[pixel]))[::-1]
        rows[pixel[seen]] = face[seen]  # the last of several stays: the lowest row
    return rows.reshape(height, width)


def _depth_planes(depth: Floats, faces: Integers, affine: Floats) -> Floats:
    """Three numbers a face (m, 3): the depth at a pixel, from 0 to 1 over all faces, is zx x + zy y + z0."""
    corners = depth[faces]
    lowest, span = corners.min(initial=np.inf), np.ptp(corners) if len(corners) else 0.0
    corners = (corners - lowest) / (span if span > 0.0 else 1.0)
    edges = corners[:, 1:] - corners[:, :1]
    planes = edges[:, :1] * affine[:, :3] + edges[:, 1:] * affine[:, 3:]
    planes[:, 2] += corners[:, 0]
    return planes


def _candidates(
    points: Floats, faces: Integers, growth: Singles, height: int, width: int
) -> Iterator[tuple[Integers, Integers, Integers]]:
    """Face, x and y of the pixels of bounding boxes, in the order of the faces."""
    corners = points[:, :2][faces]
    low, high = corners.min(axis=1), corners.max(axis=1)
    margin = (high - low) * growth[:, None]
    first = np.maximum(np.ceil(low - margin), 0).astype(np.int64)
    last = np.minimum(np.floor(high + margin), [width - 1, height - 1]).astype(np.int64)
    columns, lines = np.maximum(last - first + 1, 0).T
    counts = columns * lines
    ends = np.cumsum(counts)
    start = 0
    while start < len(faces):
        done = ends[start] - counts[start]
        stop = max(start + 1, int(np.searchsorted(ends, done + _CANDIDATES, side="right")))
        block = counts[start:stop]
        face = np.repeat(np.arange(start, stop), block)
        number = np.arange(len(face)) - np.repeat(ends[start:stop] - block - done, block)
        line, column = np.divmod(number, columns[face])
        yield face, first[face, 0] + column, first[face, 1] + line
        start = stop
