"""Landmarks by a cascade of linear regressions on orientation maps around the points."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.landmarks.search.face_crop import face_crop, point_descriptors
from toongeo.pipeline.landmarks.search.frames import applied, composed, inverse, similarity_onto

__all__ = ["PART_PX", "PART_RADIUS_PX", "Cascade", "CascadeStage", "PartCascade", "realigned", "shape_terms"]

PART_PX = 80  # of the crop of one part
PART_RADIUS_PX = 20.0  # root mean square radius of its points there
_SHAPE_WEIGHT = 0.03  # of a px of shape, beside descriptors of norm one


@dataclass(frozen=True, eq=False)
class CascadeStage:
    """One regression on k points.

    Attributes
    ----------
    radius : float, px of the crop
        Of the ring of samples about each point.
    blurs : (float, float), px
    mean : (k, d) float32
        Of the descriptors of each point.
    axes : (k, d, c) float32
        Their principal axes.
    weights : (k * c + s + 1, 2 * k) float32
        From the coordinates along the axes, s terms of the shape so far and a constant to the steps of the points.
    """

    radius: float
    blurs: tuple[float, float]
    mean: NDArray[np.float32]
    axes: NDArray[np.float32]
    weights: NDArray[np.float32]

    def coordinates(self, crop: np.ndarray, points: NDArray[np.float64]) -> NDArray[np.float32]:
        """(k * c,) of the descriptors at points (k, 2) in a crop."""
        rows = point_descriptors(crop, points, self.radius, self.blurs) - self.mean
        return np.matmul(rows[:, None], self.axes)[:, 0].ravel()

    def moved(self, crop: np.ndarray, points: NDArray[np.float64], shape: NDArray[np.float32]) -> NDArray[np.float64]:
        """The points (k, 2) after this stage; `shape` (s,) are the terms of the shape so far."""
        row = np.concatenate([self.coordinates(crop, points), shape, np.ones(1, np.float32)])
        return points + (row @ self.weights).reshape(-1, 2)


@dataclass(frozen=True, eq=False)
class PartCascade:
    """A part of the face by itself, at its own scale: `rows` (k,) of the 68 points, their mean shape (k, 2) in a crop
    of `PART_PX`, and the stages."""

    rows: NDArray[np.int64]
    shape: NDArray[np.float64]
    stages: tuple[CascadeStage, ...]

    def run(self, grey: np.ndarray, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """The points (k, 2) px of this part, from where they are."""
        for stage in self.stages:
            matrix = similarity_onto(points, self.shape)
            here = applied(matrix, points)
            points = applied(inverse(matrix), stage.moved(face_crop(grey, matrix, PART_PX), here, self.terms(here)))
        return points

    def terms(self, points: NDArray[np.float64]) -> NDArray[np.float32]:
        """(2 * k,) of the shape so far, to go beside descriptors."""
        return ((points - self.shape).ravel() * _SHAPE_WEIGHT).astype(np.float32)


@dataclass(frozen=True, eq=False)
class Cascade:
    """The mean shape (68, 2) in the crop, axes (136, s) of the shapes about it, the stages, and the parts.

    A cascade of regressions on local descriptors after X. Xiong, F. De la Torre, "Supervised descent method", CVPR
    2013; here the crop is aligned anew, rotation included, before each stage. The last stages see one part of the face
    each, aligned by itself: a caricature's mouth of twice the usual size looks like any other then. There are two sets:
    `parts` learnt from people and figures, `photo_parts` without figures drawn in the plane.
    """

    shape: NDArray[np.float64]
    shape_axes: NDArray[np.float32]
    stages: tuple[CascadeStage, ...]
    parts: tuple[PartCascade, ...] = ()
    photo_parts: tuple[PartCascade, ...] = ()

    def rough(self, grey: np.ndarray, start: NDArray[np.float64], stages: int) -> NDArray[np.float64]:
        """Points (68, 2) px after the first stages, from the mean shape under a similarity (2, 3) picture -> crop."""
        matrix, points = start, self.shape
        for k, stage in enumerate(self.stages[:stages]):
            if k:
                matrix, points = realigned(matrix, points, self.shape)
            points = stage.moved(face_crop(grey, matrix), points, shape_terms(points, self))
        return applied(inverse(matrix), points)

    def run(self, grey: np.ndarray, start: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (68, 2) px of the picture after all stages and all `parts`."""
        return self.refined(grey, self.rough(grey, start, len(self.stages)))

    def refined(self, grey: np.ndarray, points: NDArray[np.float64], photo: float = 0.0) -> NDArray[np.float64]:
        """Points (68, 2) px after each part went on by itself from where its points are; `photo_parts`, one for each of
        the first parts, have the share `photo` in [0, 1]."""
        out = points.copy()
        for k, part in enumerate(self.parts):
            share = photo if k < len(self.photo_parts) else 0.0
            start = points[part.rows]
            here = part.run(grey, start) if share < 1 else start
            out[part.rows] = here if not share else here + share * (self.photo_parts[k].run(grey, start) - here)
        return out


def realigned(
    matrix: NDArray[np.float64], points: NDArray[np.float64], shape: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The matrix and the points after the similarity that brings the points nearest to the mean shape."""
    step = similarity_onto(points, shape)
    return composed(step, matrix), applied(step, points)


def shape_terms(points: NDArray[np.float64], cascade: Cascade) -> NDArray[np.float32]:
    """(s,) coordinates of the shape so far along the axes of all shapes, scaled to go beside descriptors."""
    offset = (points - cascade.shape).ravel().astype(np.float32)
    return (offset @ cascade.shape_axes) * np.float32(_SHAPE_WEIGHT)
