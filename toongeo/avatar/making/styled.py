"""The stage that draws a photograph before a head is made of it."""

from functools import partial

import numpy as np

from toongeo.io import check_image
from toongeo.pipeline import stylize
from toongeo.pipeline.stylize.stylize import check_style
from toongeo.protocols import Stylized, Stylizer

__all__ = ["check_stylizer", "styled"]


def check_stylizer(style: str | Stylizer | None) -> Stylizer | None:
    """What draws the picture, by the name of a style.

    Raises
    ------
    ValueError
        If it is neither a known style, nor a Stylizer, nor None.
    """
    if style is None or callable(style):
        return style
    check_style(style)
    return partial(stylize, style=style)


def styled(img: np.ndarray, landmarks: np.ndarray, stylizer: Stylizer) -> Stylized:
    """The drawing of a picture.

    Raises
    ------
    ValueError
        If the stylizer gives anything but a picture (H, W, 3) uint8 with 68 landmarks, and a texture of its size.
    """
    drawing = stylizer(img, landmarks)
    check_image(drawing.img, "style")
    check_image(drawing.texture, "style")
    if drawing.texture.shape != drawing.img.shape or np.shape(drawing.landmarks) != (68, 2):
        raise ValueError(
            f"style: expected a texture of the drawing's shape {drawing.img.shape} and landmarks (68, 2), got "
            f"{drawing.texture.shape} and {np.shape(drawing.landmarks)}"
        )
    return drawing
