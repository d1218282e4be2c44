"""Normals of the samples as functions of the vertices around them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry._cross import cross
from toongeo.pipeline.fit.photometric_samples import PhotometricSamples

__all__ = ["SampleNormals", "sample_normals"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SampleNormals:
    """Unit normals (k, 3), the lengths (k,) of the sums of cross products that they came from, and what a gradient
    needs: the sides (3, 3, t) opposite the corners of the triangles around, coordinates first in the second axis.
    """

    units: Floats
    lengths: Floats
    opposite: Floats
    samples: PhotometricSamples

    def pulled_back(self, gradient: Floats, count: int) -> Floats:
        """Gradient (count, 3) by the vertices from that by the normals (k, 3).

        ``dn = (I - n n^T) dm / |m|``, and each triangle adds ``sum_v dp_v x e_v`` to ``dm``, with the opposite side
        ``e_v``.
        """
        tangent = gradient - (gradient * self.units).sum(axis=1, keepdims=True) * self.units
        along = (tangent / self.lengths[:, None])[self.samples.around].T
        forces = np.concatenate([cross(side, along) for side in self.opposite], axis=1)
        at = self.samples.corners.T.ravel()
        return np.stack([np.bincount(at, row, count) for row in forces], axis=1)


def sample_normals(points: Floats, samples: PhotometricSamples) -> SampleNormals:
    """Area-weighted normals, as of `toongeo.geometry.vertex_normals`, of the samples alone.

    Parameters
    ----------
    points : (r, 3) float
        The vertices that ``samples.mean`` lists, wherever they are now.
    samples : PhotometricSamples
    """
    X = np.ascontiguousarray(points.T)
    a, b, c = (X[:, corner] for corner in samples.corners.T)
    opposite = np.stack([b - c, c - a, a - b])
    area = cross(opposite[1], opposite[2])  # (b - a) x (c - a)
    total = np.stack([np.bincount(samples.around, row, len(samples.own)) for row in area], axis=1)
    lengths = np.maximum(np.linalg.norm(total, axis=1), np.finfo(float).tiny)
    return SampleNormals(total / lengths[:, None], lengths, opposite, samples)
