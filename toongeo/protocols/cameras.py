"""Cameras."""

from typing import Protocol

import numpy as np

__all__ = ["Camera", "HeadCamera"]


class Camera(Protocol):
    """A map from the model frame (mm) to the image frame (pixels; x right, y down; integer = pixel centre)."""

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
