"""Cameras."""

from typing import Protocol

import numpy as np

__all__ = ["Camera", "HeadCamera"]


class Camera(Protocol):
    """A map from the model frame (mm) to the image frame (pixels; x right, y down; integer = pixel centre).

    :func:`toongeo.testing.check_camera` checks one; ``render_mesh(surface, camera)`` uses it.

    Examples
    --------
    >>> from toongeo.testing import check_camera
    >>> class FromAbove:
    ...     "Looks down on the crown, the face towards the bottom of the picture, 2 px a mm."
    ...     def view(self, points):
    ...         return np.asarray(points) @ np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]).T
    ...     def project(self, points):
    ...         return 2 * self.view(points)[:, :2] * [1, -1] + 256
    ...     def depth(self, points):
    ...         return self.view(points)[:, 2]
    ...     def unproject(self, pixels, depth):
    ...         seen = np.column_stack([(np.asarray(pixels) - 256) / [2, -2], depth])
    ...         return seen @ np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    >>> check_camera(FromAbove())
    """

    def project(self, points: np.ndarray) -> np.ndarray:
        """Pixels (k, 2) of model-frame points (k, 3)."""
        ...

    def depth(self, points: np.ndarray) -> np.ndarray:
        """Distance towards the viewer (k,) in mm; larger is nearer."""
        ...

    def view(self, points: np.ndarray) -> np.ndarray:
        """Camera-frame coordinates (k, 3) in mm: +X right, +Y up, +Z towards the viewer."""
        ...

    def unproject(self, pixels: np.ndarray, depth: np.ndarray) -> np.ndarray:
        """Model-frame points (k, 3) whose pixels (k, 2) and depth (k,) are given; inverse of project and depth."""
        ...


class HeadCamera(Camera, Protocol):
    """A camera that sees a head and that a fit can follow."""

    @property
    def yaw(self) -> float:
        """Degrees; > 0 faces the subject's left."""
        ...

    @property
    def pitch(self) -> float:
        """Degrees; > 0 nods down."""
        ...

    @property
    def roll(self) -> float:
        """Degrees; > 0 is counter-clockwise in the image."""
        ...

    def cropped(self, corner: np.ndarray, factor: float) -> "HeadCamera":
        """Camera whose pixels are ``factor * (px - corner)``: of a picture that is cut, then resized."""
        ...

    def jacobian(self, points: np.ndarray) -> np.ndarray:
        """Derivative (k, 2, 3), px/mm, of the pixels by model-frame points (k, 3)."""
        ...
