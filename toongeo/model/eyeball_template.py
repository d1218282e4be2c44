"""The eyeball of a morphable model."""

from dataclasses import dataclass, fields

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored

__all__ = ["EyeballTemplate"]


@dataclass(frozen=True, eq=False)
class EyeballTemplate:
    """A sphere with an iris, placed by the identity coefficients.

    Attributes
    ----------
    centre : (3,) float64, mm, model frame
    radius : float, mm
    centre_modes : (k, 3) float32
        Motion of the centre per unit of identity coefficient.
    radius_modes : (k,) float32
    vertices : (p, 3) float64
        Unit sphere whose pole +Z is the direction of gaze.
    faces : (f, 3) int64, counter-clockwise from outside
    uv : (p, 2) float64
        Azimuthal coordinates about the pole, in the atlas of the model.
    colour : (p, 3) float32
        Default sRGB colour in [0, 1].
    iris_angle, pupil_angle : float
        Polar angles of limbus and pupil edge, radians.
    """

    centre: np.ndarray
    radius: float
    centre_modes: np.ndarray
    radius_modes: np.ndarray
    vertices: np.ndarray
    faces: np.ndarray
    uv: np.ndarray
    colour: np.ndarray
    iris_angle: float
    pupil_angle: float

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, *(field.name for field in fields(self)))

    def placed(self, identity: np.ndarray | None = None) -> tuple[np.ndarray, float]:
        """Centre (3,) and radius, mm, for identity coefficients (k,); None is the mean face."""
        if identity is None:
            return self.centre, self.radius
        return self.centre + identity @ self.centre_modes, float(self.radius + identity @ self.radius_modes)
