"""The points of a morphable model that are compared with the picture, gathered once a model."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.model.morphable_model import MorphableModel

__all__ = ["PhotometricSamples", "photometric_samples"]


@dataclass(frozen=True, eq=False)
class PhotometricSamples:
    """Vertices of the face, about evenly spread over it, the same on both sides of it.

    Attributes
    ----------
    vertices : (k,) int, ascending
    area : (k,) float, mm^2
        The part of the mean face that each stands for.
    mean : (r, 3) float
        The samples and all vertices that share a triangle with one of them.
    modes : (3 r, c) float32 or float64
        Columns are identity, then expression. Millimetres; float32 halves the time and costs 1e-5 mm.
    own : (k,) int
        Row of each sample in ``mean``.
    corners : (t, 3) int
        Triangles around the samples, as rows of ``mean``; one that has two samples is there twice.
    around : (t,) int
        Around which sample each of them lies.
    albedo_mean : (k, 3) float, sRGB
    albedo : (3 k, a) float
    faces : (f, 3) int
        Triangles of the front skin, which can hide one another; rows of the whole mesh.
    """

    vertices: NDArray[np.int64]
    area: Floats
    mean: Floats
    modes: NDArray[np.floating]
    own: NDArray[np.int64]
    corners: NDArray[np.int64]
    around: NDArray[np.int64]
    albedo_mean: Floats
    albedo: Floats
    faces: NDArray[np.int64]

    def subset(self, rows: NDArray[np.int64]) -> PhotometricSamples:
        """Only the samples ``rows`` (r,)."""
        coordinates = (3 * rows[:, None] + np.arange(3)).ravel()
        row = np.full(len(self.vertices), -1)
        row[rows] = np.arange(len(rows))
        kept = row[self.around] >= 0
        return PhotometricSamples(
            vertices=self.vertices[rows],
            area=self.area[rows],
            mean=self.mean,
            modes=self.modes,
            own=self.own[rows],
            corners=self.corners[kept],
            around=row[self.around[kept]],
            albedo_mean=self.albedo_mean[rows],
            albedo=self.albedo[coordinates],
            faces=self.faces,
        )


@lru_cache(maxsize=4)
def photometric_samples(model: MorphableModel, count: int) -> PhotometricSamples:
    """About ``count`` samples of the region ``"face"`` of a model; kept for the last few models."""
    face = model.region("face")
    faces = model.faces[face[model.faces].all(axis=1)]
    area = _vertex_area(model.mean, faces)
    vertices, share = _spread(model, np.flatnonzero(face & (area > 0)), area, count)
    which, corner = np.nonzero(np.isin(model.faces, vertices))
    ring = np.unique(model.faces[which])
    modes = np.concatenate([model.identity[:, ring], model.expression[:, ring]])
    return PhotometricSamples(
        vertices=vertices,
        area=share,
        mean=model.mean[ring],
        modes=np.ascontiguousarray(modes.transpose(1, 2, 0).reshape(3 * len(ring), -1)),
        own=np.searchsorted(ring, vertices),
        corners=np.searchsorted(ring, model.faces[which]),
        around=np.searchsorted(vertices, model.faces[which, corner]),
        albedo_mean=model.albedo_mean[vertices].astype(np.float64),
        albedo=model.albedo[:, vertices].transpose(1, 2, 0).reshape(3 * len(vertices), -1).astype(np.float64),
        faces=faces,
    )


def _vertex_area(V: Floats, F: NDArray[np.int64]) -> Floats:
    """A third of the triangles around each vertex (n,)."""
    a = V[F[:, 0]]
    thirds = np.linalg.norm(np.cross(V[F[:, 1]] - a, V[F[:, 2]] - a), axis=1) / 6
    return np.bincount(F.ravel(), np.repeat(thirds, 3), len(V)).astype(np.float64)


def _spread(
    model: MorphableModel, candidates: NDArray[np.int64], area: Floats, count: int
) -> tuple[NDArray[np.int64], Floats]:
    """Systematic sampling of one half in proportion to area, no vertex twice, then mirrored.

    The rows of a mesh follow its surface, so that every n-th of them is spread over it.
    """
    half = candidates[candidates <= model.mirror[candidates]]
    weight = np.where(half == model.mirror[half], 0.5, 1.0)
    chance = _chances(area[half], weight, count / 2)
    steps = np.floor(np.cumsum(chance) + 0.5)
    kept = np.flatnonzero(np.diff(steps, prepend=0.0) > 0)
    share = area[half[kept]] / chance[kept]
    vertices = np.concatenate([half[kept], model.mirror[half[kept]]])
    vertices, first = np.unique(vertices, return_index=True)
    return vertices, np.tile(share, 2)[first]


def _chances(area: Floats, weight: Floats, count: float) -> Floats:
    """Chance of each vertex to be taken: in proportion to its area, at most 1, with the weighted sum ``count``."""
    if count >= weight.sum():
        return np.ones_like(area)
    low, high = 0.0, 1.0 / float(area.min())
    for _ in range(60):  # the sum rises with the density, so halve
        middle = (low + high) / 2
        low, high = (middle, high) if weight @ np.minimum(1.0, middle * area) < count else (low, middle)
    return np.minimum(1.0, high * area)
