"""The stage that draws a photograph before a head is made of it."""

from dataclasses import replace
from functools import partial

import numpy as np

from toongeo.io import check_image
from toongeo.pipeline import stylize
from toongeo.pipeline.stylize.stylize import check_style
from toongeo.protocols import HairMask, Stylized, Stylizer

__all__ = ["check_stylizer", "drawn_hair", "styled"]


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


def drawn_hair(drawing: Stylized) -> HairMask | None:
    """The hair of a drawing, if its stylizer has found that of the photograph."""
    hair = drawing.hair
    if hair is None:
        return None
    alpha = hair.mask if hair.alpha is None else hair.alpha
    hat = np.zeros_like(hair.mask) if hair.hat is None else hair.hat
    moved = drawing.warp.picture(np.dstack([hair.mask, alpha, hat]).astype(np.float32))
    mask = moved[..., 0] > 0.5
    return replace(hair, mask=mask, alpha=np.clip(moved[..., 1], 0, 1), hat=(moved[..., 2] > 0.5) & ~mask)


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
