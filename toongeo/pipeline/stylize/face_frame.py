"""The frame in which styles are written: it moves, turns and grows with the face."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo.arrays import Floats

__all__ = ["FaceFrame", "face_frame"]

_OUTER_EYES = (36, 45)


@dataclass(frozen=True, eq=False)
class FaceFrame:
    """Origin between the outer corners of the eyes, axes across and down the face, and its size.

    Attributes
    ----------
    origin : (2,) float, px
    axes : (2, 2) float
        Rows: unit vectors across the face (to the right of the picture) and down it.
    size : float, px
        Root of the area of the landmarks' hull.
    """

    origin: Floats
    axes: Floats
    size: float

    __repr__ = brief_repr

    def to_frame(self, points: Floats) -> Floats:
        """Points (..., 2) in face sizes, from pixels."""
        return np.asarray((points - self.origin) @ self.axes.T / self.size)

    def to_px(self, points: Floats) -> Floats:
        """Pixels (..., 2) of points in face sizes."""
        return np.asarray(self.origin + self.size * points @ self.axes)

    def scaled(self, factor: float) -> "FaceFrame":
        """The frame in a picture that was resized; pixel centres are integers in both."""
        return FaceFrame((self.origin + 0.5) * factor - 0.5, self.axes, self.size * factor)


def face_frame(landmarks: Floats) -> FaceFrame:
    """Frame of a face with all its landmarks (68, 2), px."""
    right, left = landmarks[list(_OUTER_EYES)]
    across = (left - right) / np.linalg.norm(left - right)
    hull = cv2.convexHull(landmarks.astype(np.float32))
    return FaceFrame(
        (right + left) / 2, np.stack([across, [-across[1], across[0]]]), float(np.sqrt(cv2.contourArea(hull)))
    )
