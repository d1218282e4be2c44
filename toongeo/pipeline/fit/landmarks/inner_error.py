"""How well a face meets its landmarks."""

import numpy as np
from numpy.typing import NDArray

from toongeo.model.ibug68 import INNER, OUTER_EYES

__all__ = ["inner_error"]


def inner_error(fitted: NDArray[np.float64], pixels: NDArray[np.float64]) -> tuple[float, float]:
    """Root mean square error of the inner landmarks, px, and the distance of the outer eye corners, px.

    Parameters
    ----------
    fitted : (68, 2) float, px
        Landmarks of the face.
    pixels : (68, 2) float, px
        Landmarks of the picture; NaN rows are missing. An eye corner that is missing is taken from the face.
    """
    squares = ((fitted - pixels)[INNER] ** 2).sum(axis=1)
    right, left = np.where(np.isfinite(pixels), pixels, fitted)[list(OUTER_EYES)]
    there = np.isfinite(squares)
    rms = float(np.sqrt(squares[there].mean())) if there.any() else float("nan")
    return rms, float(np.linalg.norm(left - right))
