"""From photographs to drawings."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only, restored
from toongeo.protocols.face_parse import HairMask

__all__ = ["PictureWarp", "Stylized", "Stylizer"]


class PictureWarp(Protocol):
    """A smooth map of the picture plane onto itself, without folds."""

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
    """Draws a photograph; a network, say, or :func:`toongeo.stylize` with a style."""

    def __call__(self, img: np.ndarray, landmarks: np.ndarray) -> Stylized:
        """The drawing of a picture (H, W, 3) uint8 RGB whose face has landmarks (68, 2) px."""
        ...
