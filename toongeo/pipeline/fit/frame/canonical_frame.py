"""The frame in which the fit is solved: the picture as the first pose sees it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from toongeo.arrays import Floats
from toongeo.geometry.rotations.rotation_vectors import rotation_matrix
from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose
from toongeo.pipeline.fit.frame.unknowns import Unknowns
from toongeo.protocols import HeadCamera
from toongeo.render.camera import ScaledOrthographicCamera
from toongeo.render.perspective_camera import PerspectiveCamera

__all__ = ["CanonicalFrame", "canonical_frame"]

_FLIP = np.array([1.0, -1.0])


@dataclass(frozen=True, eq=False)
class CanonicalFrame:
    """A similarity between the picture and a plane in mm, y up, in which the first pose has no roll and
    scale 1.

    Solving there makes the fit blind to the size, place and tilt of the face in its picture.

    Attributes
    ----------
    scale : float, px/mm
    roll : (3, 3), rotation about the viewing axis
    origin : (2,), px
    rotation0 : (3, 3)
        First pose without its roll; the unknown rotation is ``exp([w]x) rotation0``.
    """

    scale: float
    roll: Floats
    origin: Floats
    rotation0: Floats

    def from_pixels(self, pixels: Floats) -> Floats:
        """Picture (k, 2) px -> plane (k, 2) mm."""
        return (pixels - self.origin) * _FLIP @ self.roll[:2, :2] / self.scale

    def rotation(self, x: Floats, unknowns: Unknowns) -> Floats:
        """Rotation (3, 3) from the model to this frame for the unknowns ``x``."""
        return rotation_matrix(x[unknowns.rotation]) @ self.rotation0

    def camera(self, x: Floats, unknowns: Unknowns, principal_point: Floats) -> HeadCamera:
        """Camera of the picture for the unknowns ``x``; the principal point, px, counts in perspective only."""
        if unknowns.perspective:
            growth, near = np.exp(x[unknowns.log_scale]), x[unknowns.inverse_distance]
            centre = np.array([*(x[unknowns.translation] / growth), -1 / (near * growth)])
            rotation = self.roll @ self.rotation(x, unknowns)
            return PerspectiveCamera(float(self.scale / near), rotation, self.roll @ centre, principal_point)
        shift = self.scale * (self.roll[:2, :2] @ x[unknowns.translation]) * _FLIP
        return ScaledOrthographicCamera(
            float(self.scale * np.exp(x[unknowns.log_scale])),
            self.roll @ self.rotation(x, unknowns),
            self.origin + shift,
        )


def canonical_frame(points: Floats, pixels: Floats, weights: Floats | None = None) -> CanonicalFrame:
    """Frame of the closed-form pose of model points (k, 3) mm seen at pixels (k, 2), weighted (k,).

    Raises
    ------
    ValueError
        If the pixels lie on a line.
    """
    scale, rotation, origin = scaled_orthographic_pose(points, pixels, weights)
    angle = np.arctan2(-rotation[0, 1], rotation[1, 1])
    roll = rotation_matrix(np.array([0.0, 0.0, angle]))
    return CanonicalFrame(scale, roll, origin, roll.T @ rotation)
