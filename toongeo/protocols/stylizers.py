"""From photographs to drawings."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.protocols.face_parse import HairMask

__all__ = ["PictureWarp", "Stylized", "Stylizer"]


class PictureWarp(Protocol):
    """A smooth map of the picture plane onto itself, without folds.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> class Shift:
    ...     "Two pixels to the right."
    ...     def points(self, points):
    ...         return points + [2.0, 0.0]
    ...     def inverse(self, points):
    ...         return points - [2.0, 0.0]
    ...     def picture(self, img):
    ...         return np.roll(img, 2, axis=1)
    ...
    >>> warp: tg.PictureWarp = Shift()
    >>> warp.inverse(warp.points(np.array([[3.0, 4.0]])))
    array([[3., 4.]])
    """

    def points(self, points: np.ndarray) -> np.ndarray:
        """Where points (..., 2) px of the photograph go in the drawing."""
        ...

    def inverse(self, points: np.ndarray) -> np.ndarray:
        """Where points (..., 2) px of the drawing come from."""
        ...

    def picture(self, img: np.ndarray) -> np.ndarray:
        """A picture (H, W[, c]) of the photograph's frame, such as a mask, after the warp."""
        ...


@dataclass(frozen=True, eq=False)
class Stylized:
    """A drawing of a face.

    Attributes
    ----------
    img : (H, W, 3) uint8 RGB
        The drawing, of the photograph's size.
    landmarks : (68, 2) float64, px
        The photograph's, warped: iBUG-68, in the drawing.
    warp : PictureWarp
        From the photograph to the drawing.
    texture : (H, W, 3) uint8 RGB
        The variant that an avatar is textured with: without light, which the avatar has of its own, and without lines
        that would be wrong once it moves.
    hair : HairMask, optional
        The hair of the photograph, in its frame, if the stylizer has looked for it: it need not be found twice.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> class Grey:
    ...     "A stylizer that moves nothing."
    ...     def points(self, points):
    ...         return points
    ...     inverse = picture = points
    ...     def __call__(self, img, landmarks):
    ...         grey = np.repeat(img.mean(2, keepdims=True), 3, axis=2).astype(np.uint8)
    ...         return tg.Stylized(grey, landmarks, self, grey)
    ...
    >>> drawing = Grey()(np.full((8, 8, 3), (10, 20, 30), dtype=np.uint8), np.zeros((68, 2)))
    >>> drawing.img[0, 0], drawing.landmarks.shape
    (array([20, 20, 20], dtype=uint8), (68, 2))
    """

    img: np.ndarray
    landmarks: np.ndarray
    warp: PictureWarp
    texture: np.ndarray
    hair: HairMask | None = None

    __repr__ = brief_repr
    __setstate__ = restored

    def __post_init__(self) -> None:
        read_only(self, "img", "landmarks", "texture")


class Stylizer(Protocol):
    """Draws a photograph; a network, say, or :func:`toongeo.stylize` with a style.

    Examples
    --------
    >>> import numpy as np
    >>> import toongeo as tg
    >>> class Grey:
    ...     "A stylizer that moves nothing."
    ...     def points(self, points):
    ...         return points
    ...     inverse = picture = points
    ...     def __call__(self, img, landmarks):
    ...         grey = np.repeat(img.mean(2, keepdims=True), 3, axis=2).astype(np.uint8)
    ...         return tg.Stylized(grey, landmarks, self, grey)
    ...
    >>> stylizer: tg.Stylizer = Grey()  # tg.make_avatar(img, style=stylizer)
    >>> stylizer(np.full((8, 8, 3), (10, 20, 30), dtype=np.uint8), np.zeros((68, 2))).img[0, 0]
    array([20, 20, 20], dtype=uint8)
    """

    def __call__(self, img: np.ndarray, landmarks: np.ndarray) -> Stylized:
        """The drawing of a picture (H, W, 3) uint8 RGB whose face has landmarks (68, 2) px."""
        ...
