"""Where in an eye an iris may be, and how large.

Constants were chosen by eye; which of the seven examples and 15 caricatures were looked at was not written down.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import cv2
import numpy as np
from scipy.fft import fftfreq, ifft, irfft, rfft2

from toongeo.arrays import Singles

__all__ = ["VIEW", "WIDTH", "iris_scores", "squared_cost"]

WIDTH = 48  # px of an eye in its view
VIEW = 72  # px: side of a view
_PERIOD = 120  # px: what a view and the largest ellipse take together
# Semi-axes looked for, in widths of the eye, and height over width: drawn irises may be tall and fill the eye.
_SIZES = (0.12, 0.14, 0.165, 0.19, 0.22, 0.25, 0.29, 0.34, 0.4, 0.46)
_ASPECTS = (0.85, 1.0, 1.2, 1.45, 1.8)
_EDGE = 1.5  # px of a view: thickness of the two rings that are compared
_STEP = 0.25  # weight of the step along the rim, against a whole opening that is held
# Cost, mean and s.d. of log size and log aspect.
_SIZE_PRIOR, _ASPECT_PRIOR = (0.02, np.log(0.21), np.log(1.5)), (0.04, 0.0, np.log(1.3))
_PLACE_COST = 0.008  # of an iris a s.d. above or below the middle of the opening
_NARROW_COST = 0.3  # of an iris at a corner
_BRIGHT_INSIDE = -0.4  # highlights in an iris count less than dark pixels beside it


def iris_scores(dark: Singles, opening: Singles) -> Iterator[tuple[list[Singles], float, float]]:
    """How well an iris suits every place of each eye, for one size and aspect after the other.

    All sums over ellipses at all places are products of spectra.

    Parameters
    ----------
    dark : (e, VIEW, VIEW) float32
        How dark the pixels of each eye are, in [-1, 1]; 0 outside the opening.
    opening : (e, VIEW, VIEW) float32
        1 between the lids.

    Yields
    ------
    scores : list of e (VIEW, VIEW) float32
        Greater is better; minus infinity outside the opening.
    size, aspect : float
        Semi-axis across, in widths of the eye, and that down in semi-axes across. Likely ones come first.
    """
    y = np.arange(VIEW)[:, None]
    costs = [_place_cost(eye, y) for eye in opening]
    areas = opening.sum((1, 2))
    images = np.stack([dark, opening, np.maximum(dark, _BRIGHT_INSIDE)])
    darkness, open_, held = rfft2(images, (_PERIOD, _PERIOD))[:, :, None]
    for (size, aspect), masks in _masks().items():
        rings, disc = masks.spectra[:2], masks.spectra[2:]
        sums = _at_places(np.concatenate([darkness * rings, open_ * rings, held * disc], axis=1))
        scores = [
            _score(of, float(area), masks.area) - cost - np.float32(_unlikely((size, aspect)))
            for of, area, cost in zip(sums, areas, costs, strict=True)
        ]
        yield scores, size, aspect


def _score(sums: Singles, opening: float, area: float) -> Singles:
    """What each place holds of the dark pixels, as a share of the opening, plus the step of darkness along its rim.

    ``sums`` are those of darkness and of the opening in the two rings, and of darkness inside; ``area`` is that of the
    outer ring.
    """
    dark, rings, held = sums[:2], np.maximum(sums[2:4], 0), sums[4]
    inner, outer = dark / np.maximum(rings, 1)
    visible = np.minimum(*rings) / np.float32(area)
    return np.asarray(held / np.float32(opening) + np.float32(_STEP) * visible * (inner - outer))


@dataclass(frozen=True, eq=False)
class _Masks:
    """Spectra of an ellipse's inner ring, outer ring and inside; and the area of its outer ring."""

    spectra: np.ndarray
    area: float


@lru_cache(maxsize=1)
def _masks() -> dict[tuple[float, float], _Masks]:
    """Of every size and aspect, the likely ones first: those that are not can then be passed over."""
    masks = {}
    for size, aspect in sorted(itertools.product(_SIZES, _ASPECTS), key=_unlikely):
        discs = [_disc(size * WIDTH + grow, size * WIDTH * aspect + grow) for grow in (-_EDGE, 0.0, _EDGE)]
        stack = np.stack([discs[1] - discs[0], discs[2] - discs[1], discs[1]])
        masks[size, aspect] = _Masks(rfft2(stack), float(stack[1].sum()))
    return masks


def _unlikely(shape: tuple[float, float]) -> float:
    return float(squared_cost(np.log(shape[0]), *_SIZE_PRIOR) + squared_cost(np.log(shape[1]), *_ASPECT_PRIOR))


def _disc(a: float, b: float) -> Singles:
    """An ellipse of semi-axes a, b px with a soft rim, about the first pixel of a periodic square."""
    along = fftfreq(_PERIOD, 1 / _PERIOD)
    x, y = np.meshgrid(along, along)
    return np.clip((1 - np.hypot(x / a, y / b)) * min(a, b) + 0.5, 0, 1).astype(np.float32)


def _at_places(spectra: np.ndarray) -> Singles:
    """Images (..., VIEW, VIEW) of spectra; what lies beyond the views is not computed."""
    rows = ifft(spectra, axis=-2)[..., :VIEW, :]
    return np.asarray(irfft(rows, _PERIOD, axis=-1)[..., :VIEW])


def _place_cost(opening: Singles, y: np.ndarray) -> Singles:
    """Cost (VIEW, VIEW) of a centre off the opening's middle, or where the opening narrows to its corners."""
    heights = opening.sum(0)
    narrow = 1 - heights / heights.max()
    middle = (opening * y).sum(0) / np.maximum(heights, 1)
    middle[heights == 0] = VIEW / 2
    outside = np.where(cv2.dilate(opening, np.ones((5, 5))) > 0, 0, np.inf)
    return np.asarray(
        outside + squared_cost(narrow, _NARROW_COST, 0, 1) + squared_cost(y, _PLACE_COST, middle, 0.15 * WIDTH),
        np.float32,
    )


def squared_cost(value: Any, weight: float, mean: Any, deviation: float) -> Any:
    """``weight`` for a value a standard deviation off the mean, four times that for two."""
    return weight * ((value - mean) / deviation) ** 2
