"""Where hair of the side that a turned head hides has its colours from."""

import numpy as np

from toongeo.arrays import Reals
from toongeo.pipeline.hair.plane.working_plane import WorkingPlane

__all__ = ["other_side"]

_HIDDEN = float(np.sin(np.deg2rad(12.0)))  # of the angle to the viewer beyond which one side of the hair is hidden
_BEYOND_MM = 25.0  # from the middle of the head, over which the hidden side becomes the other's


def other_side(plane: WorkingPlane, points: Reals) -> tuple[Reals, Reals]:
    """Points (k, 3) mirrored in the head's middle, and how far (k,) in [0, 1] each is on the hidden side.

    Of a head that is turned the picture shows little hair at the outline of the far side, and that in the light of
    the edge. A head that is hardly turned hides none.
    """
    towards = float(plane.rotation[2, 0])  # how far the viewer is on the subject's left
    if abs(towards) < _HIDDEN:
        return points, np.zeros(len(points))
    model = plane.back(points)
    far = np.clip(-np.sign(towards) * model[:, 0] / _BEYOND_MM, 0, 1)
    return plane.of(model * [-1, 1, 1]), far * far * (3 - 2 * far)
