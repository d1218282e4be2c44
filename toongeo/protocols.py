"""Places where another part, a learned one included, can be plugged in.

Each Protocol is satisfied by shape, not by inheritance: any object or function with these members fits.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np


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


@dataclass(frozen=True, eq=False)
class Coefficients:
    """What describes a face in a picture; any part may be None, that is, not known.

    Attributes
    ----------
    identity : (k,) float
        Standard deviations.
    expression : (e,) float
        Named expressions in [0, 1], the others in standard deviations.
    albedo : (a,) float
        Standard deviations.
    light : float array
        Spherical harmonics a channel.
    pose : HeadCamera
        From the model frame to the picture.
    """

    identity: np.ndarray | None = None
    expression: np.ndarray | None = None
    albedo: np.ndarray | None = None
    light: np.ndarray | None = None
    pose: HeadCamera | None = None

    def __post_init__(self) -> None:
        for name in ("identity", "expression", "albedo", "light"):
            value = getattr(self, name)
            if value is None:
                continue
            array = np.array(value, np.float64)
            if not np.isfinite(array).all():
                raise ValueError(f"{name}: expected finite numbers or None, got NaN or infinity")
            array.setflags(write=False)
            object.__setattr__(self, name, array)


class Regressor(Protocol):
    """Guesses the coefficients of a face; a network, say, or any function."""

    def __call__(self, img: np.ndarray | None, landmarks: np.ndarray) -> Coefficients:
        """Coefficients of the face with landmarks (68, 2) px, NaN where missing.

        The picture is (H, W, 3) uint8, or None when there is none.
        """
        ...
