"""Landmarks by a cascade of linear regressions on orientation maps around the points."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.geometry.one_thread import one_thread
from toongeo.pipeline.landmarks.search.face_crop import face_crop, point_descriptors
from toongeo.pipeline.landmarks.search.frames import applied, composed, inverse, similarity_onto

__all__ = ["SHAPE_WEIGHT", "Cascade", "CascadeStage", "realigned", "shape_terms"]

SHAPE_WEIGHT = 0.03  # of a px of shape, beside descriptors of norm one


@dataclass(frozen=True, eq=False)
class CascadeStage:
    """One regression.

    Attributes
    ----------
    radius : float, px of the crop
        Of the ring of samples about each point.
    blurs : (float, float), px
    mean : (68, d) float32
        Of the descriptors of each point.
    axes : (68, d, c) float32
        Their principal axes.
    weights : (68 * c + s + 1, 136) float32
        From the coordinates along the axes, the shape so far and a constant to the steps of the points.
    """

    radius: float
    blurs: tuple[float, float]
    mean: NDArray[np.float32]
    axes: NDArray[np.float32]
    weights: NDArray[np.float32]

    def coordinates(self, crop: NDArray[np.uint8], points: NDArray[np.float64]) -> NDArray[np.float32]:
        """(68 * c,) of the descriptors at points (68, 2) in a crop."""
        rows = point_descriptors(crop, points, self.radius, self.blurs) - self.mean
        return np.matmul(rows[:, None], self.axes)[:, 0].ravel()


@dataclass(frozen=True, eq=False)
class Cascade:
    """The mean shape (68, 2) in the crop, axes (136, s) of the shapes about it, and the stages.

    A cascade of regressions on local descriptors after X. Xiong, F. De la Torre, "Supervised descent method", CVPR
    2013; here the crop is aligned anew, rotation included, before each stage.
    """

    shape: NDArray[np.float64]
    shape_axes: NDArray[np.float32]
    stages: tuple[CascadeStage, ...]

    def run(
        self, grey: NDArray[np.uint8], start: NDArray[np.float64], stages: slice = slice(None)
    ) -> NDArray[np.float64]:
        """Points (68, 2) px of the picture, from the mean shape under a similarity (2, 3) picture -> crop."""
        matrix, points = start, self.shape
        for k, stage in enumerate(self.stages[stages]):
            if k:
                matrix, points = realigned(matrix, points, self.shape)
            coordinates = stage.coordinates(face_crop(grey, matrix), points)
            row = np.concatenate([coordinates, shape_terms(points, self), np.ones(1, np.float32)])
            with one_thread():  # how BLAS splits a sum among threads would show in the last digits
                points = points + (row @ stage.weights).reshape(-1, 2)
        return applied(inverse(matrix), points)


def realigned(
    matrix: NDArray[np.float64], points: NDArray[np.float64], shape: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The matrix and the points after the similarity that brings the points nearest to the mean shape."""
    step = similarity_onto(points, shape)
    return composed(step, matrix), applied(step, points)


def shape_terms(points: NDArray[np.float64], cascade: Cascade) -> NDArray[np.float32]:
    """(s,) coordinates of the shape so far along the axes of all shapes, scaled to go beside descriptors."""
    offset = (points - cascade.shape).ravel().astype(np.float32)
    return (offset @ cascade.shape_axes) * np.float32(SHAPE_WEIGHT)
