"""Colours carried into the palette of a drawing."""

import cv2
import numpy as np

__all__ = ["from_lab", "match_colours", "to_lab"]


def to_lab(colours: np.ndarray) -> np.ndarray:
    """CIELAB (k, 3) float32, L in 0-100, of sRGB colours (k, 3), 0-255."""
    rgb = np.clip(np.asarray(colours, np.float32) / 255, 0, 1)
    return np.asarray(cv2.cvtColor(rgb[None], cv2.COLOR_RGB2LAB)[0])


def from_lab(lab: np.ndarray) -> np.ndarray:
    """sRGB colours (k, 3), 0-255, of CIELAB (k, 3); inverse of :func:`to_lab` within the gamut."""
    return np.asarray(255 * np.clip(cv2.cvtColor(np.asarray(lab, np.float32)[None], cv2.COLOR_LAB2RGB)[0], 0, 1))


def match_colours(colours: np.ndarray, mean: np.ndarray, contrast: float) -> np.ndarray:
    """Colours with another mean, and their spread about it multiplied (Reinhard et al. 2001; AdaIN), in CIELAB.

    Parameters
    ----------
    colours : (k, 3) float, sRGB, 0-255
    mean : (3,) float, CIELAB
    contrast : float
        Ratio of the standard deviations.

    Returns
    -------
    (k, 3) float32, sRGB, 0-255

    Examples
    --------
    >>> grey = match_colours(np.array([[90.0, 90, 90], [110, 110, 110]]), np.array([50.0, 0, 0]), 0.0)
    >>> grey.round().astype(int)
    array([[119, 119, 119],
           [119, 119, 119]])
    """
    lab = to_lab(colours)
    return from_lab(np.asarray(mean) + contrast * (lab - lab.mean(0)))
