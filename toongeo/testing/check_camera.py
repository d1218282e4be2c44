"""Whether something is a `Camera`."""

from __future__ import annotations

import numpy as np

from toongeo.protocols import Camera
from toongeo.testing.example import require

__all__ = ["check_camera"]

_STEP_MM = 1e-4


def check_camera(camera: Camera, *, tolerance: float = 1e-6) -> None:
    """Look at a head's points through a camera, and back.

    A `HeadCamera` is checked for more: its jacobian, and that a crop of the picture moves the pixels.

    Parameters
    ----------
    camera : Camera
    tolerance : float
        mm and px.

    Raises
    ------
    AssertionError
        If shapes are wrong, unproject is not the inverse of project and depth, depth does not grow towards the viewer
        as the view's z, or the jacobian is not the derivative of project.

    Examples
    --------
    >>> from toongeo import PerspectiveCamera, ScaledOrthographicCamera
    >>> check_camera(ScaledOrthographicCamera.look(yaw=20.0, pitch=5.0))
    """
    points = np.random.default_rng(0).uniform(-80, 80, (50, 3))
    pixels, depth, view = camera.project(points), camera.depth(points), camera.view(points)
    shapes = np.shape(pixels) == (50, 2) and np.shape(depth) == (50,) and np.shape(view) == (50, 3)
    require(shapes, f"expected (50, 2), (50,) and (50, 3), got {np.shape(pixels)}, {np.shape(depth)}, {np.shape(view)}")
    off = np.abs(camera.unproject(pixels, depth) - points).max()
    require(off < max(tolerance, 1e-6), f"unproject: expected the points back, got them off by {off:.2g} mm")
    require((np.argsort(depth) == np.argsort(view[:, 2])).all(), "depth: expected to grow with the view's z")
    lengths = np.linalg.norm(view - view[0], axis=1), np.linalg.norm(points - points[0], axis=1)
    require(np.allclose(*lengths, atol=1e-6), "view: expected a rigid motion of the points")
    if hasattr(camera, "jacobian"):
        steps = np.eye(3) * _STEP_MM
        ahead = np.stack([camera.project(points + step) - camera.project(points - step) for step in steps], axis=2)
        worst = np.abs(camera.jacobian(points) - ahead / (2 * _STEP_MM)).max()
        require(worst < 1e-4, f"jacobian: expected the derivative of project, got it off by {worst:.2g} px/mm")
    if hasattr(camera, "cropped"):
        crop = camera.cropped(np.array([10.0, 20.0]), 0.5)
        off = np.abs(crop.project(points) - 0.5 * (pixels - [10, 20])).max()
        require(off < 1e-6, f"cropped: expected 0.5 * (px - corner), got it off by {off:.2g} px")
