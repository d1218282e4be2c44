"""Normals of the samples as functions of the vertices around them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import bsr_array

from toongeo.arrays import Floats
from toongeo.geometry.operators.cross import cross
from toongeo.pipeline.fit.photometric.photometric_samples import PhotometricSamples

__all__ = ["SampleNormals", "sample_normals"]


@dataclass(frozen=True, eq=False)
class SampleNormals:
    """Unit normals (k, 3), the lengths (k,) of the sums of cross products that they came from, and what a derivative
    needs: the sides (3, 3, t) opposite the corners of the triangles around, coordinates first in the second axis.
    """

    units: Floats
    lengths: Floats
    opposite: Floats
    samples: PhotometricSamples

    def derivative(self, slope: Floats, forces: Floats) -> bsr_array:
        """Derivative (c k, 3 r) by the vertices of quantities (k, c) that depend on normals and places of the samples.

        ``dn = (I - n n^T) dm / |m|``, and each triangle adds ``sum_v dp_v x e_v`` to ``dm``, with the opposite side
        ``e_v``.

        Parameters
        ----------
        slope, forces : (k, c, 3) float
            Derivative by the unit normals, and by the places.
        """
        samples, count = self.samples, len(self.samples.mean)
        pairs, which = np.unique(samples.around[:, None] * count + samples.corners, return_inverse=True)
        sides = self.opposite.transpose(1, 2, 0).reshape(3, -1)
        sides = np.stack([np.bincount(which.ravel(), row, len(pairs)) for row in sides])  # of both triangles
        sample, vertex = np.divmod(pairs, count)
        tangent = slope - (slope * self.units[:, None]).sum(axis=2, keepdims=True) * self.units[:, None]
        along = (tangent / self.lengths[:, None, None])[sample]
        blocks = cross(sides[:, :, None], along.transpose(2, 0, 1)).transpose(1, 2, 0)
        blocks[vertex == samples.own[sample]] += forces
        starts = np.searchsorted(sample, np.arange(len(samples.own) + 1))
        blocks = np.ascontiguousarray(blocks, samples.modes.dtype)
        return bsr_array((blocks, vertex, starts), shape=(slope.shape[1] * len(samples.own), 3 * count))


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
