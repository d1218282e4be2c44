"""The eyes of a picture upright and at one size."""

from dataclasses import dataclass

import cv2
import numpy as np

from toongeo.arrays import Floats, Singles
from toongeo.colour.cielab import cielab

__all__ = ["EyeView", "upright_eyes"]

_SIDE = 320  # px of the view
_APART = 150.0  # px between the outer eye corners: rims of drawings are then 2 to 12 px wide
_HEIGHT = 0.42  # of the view: where the eyes lie


@dataclass(frozen=True, eq=False)
class EyeView:
    """A view of the eyes.

    Attributes
    ----------
    lab : (320, 320, 3) float32 CIELAB
    points : (68, 2) float64, px of the view
    matrix : (2, 3) float64
        From the picture to the view.
    """

    lab: Singles
    points: Floats
    matrix: Floats

    @property
    def eyes(self) -> tuple[np.ndarray, np.ndarray]:
        """Points (6, 2) of the right and the left eye, px of the view."""
        return self.points[36:42], self.points[42:48]

    @property
    def eye_width(self) -> float:
        """Of both eyes in the mean, px of the picture."""
        widths = [np.linalg.norm(eye[3] - eye[0]) for eye in self.eyes]
        return float(np.mean(widths) / np.sqrt(abs(np.linalg.det(self.matrix[:, :2]))))

    def at(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Colours (k * j, 3) at all pairs of x (k,) and y (j,)."""
        columns, rows = (np.clip(np.rint(v), 0, _SIDE - 1).astype(int) for v in (x, y))
        return self.lab[rows[:, None], columns].reshape(-1, 3)

    def inside(self, points: np.ndarray, grown: float) -> np.ndarray:
        """Mask (320, 320) of a polygon (k, 2), grown about its middle."""
        corners = points.mean(0) + grown * (points - points.mean(0))
        mask = np.zeros((_SIDE, _SIDE), np.uint8)
        return cv2.fillPoly(mask, [np.rint(corners).astype(np.int32)], 1).astype(bool)

    def back(self, mask: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
        """A mask of the view as one of the picture, (H, W) bool."""
        inverse = cv2.invertAffineTransform(self.matrix)
        return np.asarray(cv2.warpAffine(mask.astype(np.float32), inverse, (shape[1], shape[0]))) > 0.5


def upright_eyes(img: np.ndarray, landmarks: np.ndarray) -> EyeView:
    """The view of a picture whose landmarks (68, 2) px of the eyes are known."""
    along = landmarks[45] - landmarks[36]
    length = max(float(np.linalg.norm(along)), 1e-9)
    scale, (cosine, sine) = _APART / length, along / length
    turn = scale * np.array([[cosine, sine], [-sine, cosine]])
    middle = (landmarks[36:42].mean(0) + landmarks[42:48].mean(0)) / 2
    matrix = np.column_stack([turn, np.array([_SIDE / 2, _SIDE * _HEIGHT]) - turn @ middle])
    if scale < 1:  # what is left out must not alias
        img = cv2.GaussianBlur(img, (0, 0), 0.5 / scale)
    view = cv2.warpAffine(img, matrix, (_SIDE, _SIDE), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return EyeView(cielab(np.asarray(view, np.uint8)).astype(np.float32), landmarks @ turn.T + matrix[:, 2], matrix)
