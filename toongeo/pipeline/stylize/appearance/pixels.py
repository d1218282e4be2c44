"""Small things done to whole pictures."""

from typing import Any

import cv2
import numpy as np

from toongeo.arrays import Floats, Singles

__all__ = ["antialiased", "blurred", "enlarged", "hull_of", "placed_in", "reduced", "rgb_of", "sampled", "soft_step"]

_EDGE = 1.4  # px over which an antialiased edge goes from 0 to 1: the diagonal of a pixel


def reduced(picture: np.ndarray, factor: float) -> np.ndarray:
    """A picture (h, w[, c]) made smaller by area means, or larger by cubic interpolation."""
    kind = cv2.INTER_AREA if factor < 1 else cv2.INTER_CUBIC
    return np.asarray(cv2.resize(picture, None, fx=factor, fy=factor, interpolation=kind))


def enlarged(picture: Singles, shape: tuple[int, ...]) -> Singles:
    """A picture (h, w[, c]) at another size (rows, columns, ...), by cubic interpolation."""
    return np.asarray(cv2.resize(picture, (shape[1], shape[0]), interpolation=cv2.INTER_CUBIC))


def blurred(picture: Singles, sigma: float) -> Singles:
    """A Gaussian mean; sigma in px."""
    return np.asarray(cv2.GaussianBlur(picture, (0, 0), max(sigma, 0.1)))


def placed_in(points: Floats, factor: float) -> Floats:
    """Points (k, 2) px in a picture that was resized by a factor; pixel centres are integers in both."""
    return np.asarray((points + 0.5) * factor - 0.5)


def hull_of(points: Floats) -> Floats:
    """Corners (k, 2) of the convex hull of points."""
    return np.asarray(cv2.convexHull(points.astype(np.float32))[:, 0], np.float64)


def rgb_of(lab: Singles) -> Singles:
    """RGB (h, w, 3) in 0..255 of CIELAB."""
    rgb = cv2.cvtColor(np.asarray(lab, np.float32), cv2.COLOR_LAB2RGB)
    return np.asarray(np.clip(rgb * 255, 0, 255))


def sampled(picture: np.ndarray, at: Singles, interpolation: int, border: int) -> Any:
    """A picture (H, W[, c]) at places (h, w, 2) px, by a kind of interpolation and of border of OpenCV."""
    remap: Any = cv2.remap  # whose types know no single map of two channels; an empty second one is slow
    return remap(picture, at, None, interpolation, borderMode=border)


def soft_step(x: Singles, softness: float) -> Singles:
    """From 0 to 1 where x rises through 0."""
    return np.asarray(0.5 + 0.5 * np.tanh(x / np.float32(softness)))


def antialiased(field: Singles, least: float) -> Singles:
    """Cover (h, w) of where a smooth field is positive: f / |grad f| is the distance to the edge in pixels.

    Where the field is flatter than ``least`` a pixel the edge is soft.
    """
    slope = np.hypot(cv2.Sobel(field, cv2.CV_32F, 1, 0), cv2.Sobel(field, cv2.CV_32F, 0, 1)) / 8
    return np.asarray(np.clip(0.5 + field / np.maximum(slope, np.float32(least)) / np.float32(_EDGE), 0, 1))
