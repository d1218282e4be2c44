"""The white of an eye, from what is drawn of it.

Constants were chosen on one half of the pictures (``benchmarks/looks.py``).
"""

from dataclasses import dataclass

import numpy as np

from toongeo.colour.cielab import cielab
from toongeo.pipeline.texture.eyes.eye_disc import EyeDisc

__all__ = ["LIGHTEST_WHITE", "Sclera", "lab_of", "smooth_step", "white_of", "white_of_lightest"]

LIGHTEST_WHITE = np.array([244.0, 242.0, 238.0])  # sRGB: that of an eye of which nothing is seen
_BESIDE = 1.12  # radii of the iris: farther from its middle the eye is white
_COLOURED = 0.8  # how much chroma speaks against white, against lightness
_NEAR = (22.0, 14.0)  # CIELAB units of lightness and of chroma about the lightest quarter: this is white
_FEWEST = 16  # texels that tell a white
_DARKEST = 38.0  # lightness: no white is darker
_FAR = 25.0  # sRGB: Tukey's constant of the fit
_FLAT = 0.05  # prior of the shading's slope, against the texels
_HOLLOW = 0.16  # by how much an eye is darker where it turns away beneath the lids
_TURN = np.deg2rad(70.0)  # from the pole: about as much as lids ever show
_DIM = (55.0, 90.0, 0.75)  # lightness from which the lightest of an eye is white; least level, and share of white


@dataclass(frozen=True, eq=False)
class Sclera:
    """A white that changes linearly over the eyeball.

    Attributes
    ----------
    middle : (3,) float64, sRGB, 0-255
    slopes : (3, 3) float64
        Of constant, x and y on the unit sphere; a row each.
    low, high : (3,) float64
        What is drawn of it lies between.
    """

    middle: np.ndarray
    slopes: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def at(self, unit: np.ndarray, *, mirrored: bool = False) -> np.ndarray:
        """Colours (k, 3) on the unit sphere (k, 3), or on that of the other eye."""
        x = -unit[:, 0] if mirrored else unit[:, 0]
        drawn = self.middle + np.column_stack([np.ones(len(x)), x, unit[:, 1]]) @ self.slopes
        return np.clip(drawn, self.low, self.high) * hollow(unit)


def hollow(unit: np.ndarray) -> np.ndarray:
    """Shade (k, 1) of an eyeball: 1 in front, less where it turns away beneath the lids."""
    turned = np.arccos(np.clip(unit[:, 2], -1, 1)) / _TURN
    return np.asarray(1 - _HOLLOW * smooth_step((turned - 0.45) / 0.5))[:, None]


def white_of(disc: EyeDisc) -> Sclera | None:
    """The white that is drawn; None where too little is.

    Only what is about as light and as colourless as the lightest quarter of the eye beside its iris counts; a robust
    linear fit over the eyeball then leaves out lashes, veins and lines.
    """
    beside = np.flatnonzero(disc.seen & (disc.away > _BESIDE))
    if len(beside) < 2 * _FEWEST:
        return None
    lab = lab_of(disc.colours[beside])
    white = lab[:, 0] - _COLOURED * np.hypot(lab[:, 1], lab[:, 2])
    middle = np.median(lab[white >= np.percentile(white, 75)], axis=0)
    off = np.abs(lab - middle)
    near = beside[(off[:, 0] < _NEAR[0]) & (np.hypot(off[:, 1], off[:, 2]) < _NEAR[1])]
    iris = disc.seen & (disc.away < 1)
    dark = np.median(lab_of(disc.colours[iris])[:, 0]) if iris.any() else 0.0
    if len(near) < _FEWEST or middle[0] < max(_DARKEST, dark):
        return None
    return _robust(disc.unit[near, :2], disc.colours[near])


def white_of_lightest(disc: EyeDisc) -> np.ndarray:
    """Colours (k, 3) of an eye on which no white is drawn: hardly coloured, and as light as its lightest."""
    if not disc.seen.any():
        return LIGHTEST_WHITE * hollow(disc.unit)
    lightest = np.percentile(disc.colours[disc.seen], 95, axis=0)
    grey = 0.5 * lightest + 0.5 * lightest.mean()
    if lab_of(grey[None])[0, 0] > _DIM[0]:
        grey = np.maximum(grey, _DIM[2] * LIGHTEST_WHITE)
    return np.clip(grey, _DIM[1], LIGHTEST_WHITE) * hollow(disc.unit)


def _robust(xy: np.ndarray, colours: np.ndarray) -> Sclera | None:
    """Iteratively reweighted least squares with Tukey's weights."""
    X = np.column_stack([np.ones(len(xy)), xy])
    middle, weight = np.median(colours, axis=0), np.ones(len(xy))
    slopes = np.zeros((3, 3))
    for _ in range(8):
        A = X.T @ (weight[:, None] * X) + _FLAT * weight.sum() * np.diag([0.0, 1.0, 1.0])
        slopes = np.linalg.solve(A, X.T @ (weight[:, None] * (colours - middle)))
        off = np.linalg.norm(colours - middle - X @ slopes, axis=1)
        weight = np.maximum(1 - (off / _FAR) ** 2, 0) ** 2
        if weight.sum() < _FEWEST / 2:
            return None
    low, high = np.percentile(colours[weight > 0.2], [5, 95], axis=0)
    return Sclera(middle, slopes, low, high)


def lab_of(colours: np.ndarray) -> np.ndarray:
    """CIELAB (k, 3) of sRGB colours (k, 3), 0-255."""
    return cielab(np.clip(np.rint(colours), 0, 255).astype(np.uint8)[None])[0]


def smooth_step(x: np.ndarray) -> np.ndarray:
    """0 up to 0, 1 from 1, smooth between.

    Examples
    --------
    >>> smooth_step(np.array([-1.0, 0.5, 2.0]))
    array([0. , 0.5, 1. ])
    """
    x = np.clip(x, 0, 1)
    return x * x * (3 - 2 * x)
