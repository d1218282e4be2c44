"""Renders unlike those that were trained on.

Whoever calibrates on pictures of the kind that was trained on will be too sure of others. Faces here are bent further
than in training, and drawn with a screen of dots or with hatching, which no style of `renders` has.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from renders.canvas import between
from renders.warp import random_warp, warped

from detector.samples import SIZE_PX, Samples, with_even_jaw

__all__ = ["strange_samples"]

_SHARE = 0.6  # of the samples; the others stay as they are
_BENT = 0.75  # of those
_AMOUNT = 0.02, 0.06  # of the picture; in training 0.06 at most, mostly less
_DOTS, _HATCHED = 0.25, 0.25


def strange_samples(samples: Samples, seed: int) -> Samples:
    """The samples, most of them made strange; each by its own random numbers."""
    grey, landmarks = samples.grey.copy(), np.array([with_even_jaw(points) for points in samples.landmarks])
    for k in range(len(grey)):
        rng = np.random.default_rng([seed, k])
        if rng.random() >= _SHARE:
            continue
        if rng.random() < _BENT:
            field = random_warp(rng, landmarks[k], SIZE_PX, between(rng, *_AMOUNT) * SIZE_PX, True)
            moved, picture = warped(field, landmarks[k], grey[k].astype(np.float32))
            grey[k], landmarks[k] = np.clip(picture, 0, 255), with_even_jaw(moved)
        kind = rng.random()
        if kind < _DOTS:
            grey[k] = _dots(rng, grey[k])
        elif kind < _DOTS + _HATCHED:
            grey[k] = _hatching(rng, grey[k])
    return Samples(grey, landmarks, samples.kinds)


def _dots(rng: np.random.Generator, grey: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A printer's screen: dots whose size tells the tone."""
    y, x = np.mgrid[: len(grey), : len(grey)]
    angle, period = between(rng, 0, np.pi / 2), between(rng, 2.5, 5)
    u, v = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
    screen = 127.5 + 63 * (np.cos(2 * np.pi * u / period) + np.cos(2 * np.pi * v / period))
    return _inked(rng, grey, np.where(grey > screen, 255.0, 0.0))


def _hatching(rng: np.random.Generator, grey: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """An engraver's lines, the more directions the darker."""
    y, x = np.mgrid[: len(grey), : len(grey)]
    ink = np.full(grey.shape, 255.0)
    turn, period = between(rng, 0, np.pi), between(rng, 2.5, 5)
    wave = cv2.GaussianBlur(rng.normal(size=grey.shape), (0, 0), 12) * 60
    for k, tone in enumerate((170, 120, 70)):
        angle = turn + k * np.pi / 3
        lines = np.sin(2 * np.pi * (x * np.cos(angle) + y * np.sin(angle) + wave) / period)
        ink[(lines > 0.3) & (grey < tone)] = 0
    return _inked(rng, grey, ink)


def _inked(rng: np.random.Generator, grey: NDArray[np.uint8], ink: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Ink over what is left of the tones, a little blurred."""
    keep = between(rng, 0.2, 0.7)
    return np.clip(cv2.GaussianBlur(keep * grey + (1 - keep) * ink, (0, 0), between(rng, 0.4, 0.9)), 0, 255).astype(
        np.uint8
    )
