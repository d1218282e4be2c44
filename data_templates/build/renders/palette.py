"""Colours of skin, hair and iris, in life and in drawings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from renders.canvas import between

__all__ = ["Palette", "random_colour", "random_palette"]

# sRGB 0-255 with a weight; the last two skins are of drawings only.
_SKIN = (
    (0.18, (240, 208, 188)),
    (0.20, (228, 184, 158)),
    (0.15, (198, 146, 116)),
    (0.12, (140, 94, 68)),
    (0.08, (88, 58, 44)),
    (0.10, (248, 222, 176)),
    (0.08, (206, 132, 100)),
    (0.05, (255, 235, 215)),
    (0.04, (190, 200, 215)),
)
_HAIR = (
    (0.22, (26, 22, 20)),
    (0.20, (58, 38, 24)),
    (0.15, (96, 62, 36)),
    (0.12, (150, 108, 58)),
    (0.08, (206, 178, 120)),
    (0.08, (178, 176, 174)),
    (0.04, (225, 225, 225)),
    (0.05, (128, 58, 28)),
    (0.03, (200, 60, 60)),
    (0.03, (70, 80, 160)),
)


@dataclass(frozen=True, eq=False)
class Palette:
    """Colours (3,) 0-255 of one person."""

    skin: NDArray[np.float64]
    hair: NDArray[np.float64]
    brows: NDArray[np.float64]
    lips: NDArray[np.float64]
    iris: NDArray[np.float64]


def random_colour(rng: np.random.Generator) -> NDArray[np.float64]:
    """Any colour (3,), 0-255."""
    return rng.uniform(0, 255, 3)


def random_palette(rng: np.random.Generator) -> Palette:
    """Colours of a person or a figure."""
    skin = _drawn(rng, _SKIN) * between(rng, 0.85, 1.08) + rng.normal(0, 6, 3)
    hair = _drawn(rng, _HAIR) * between(rng, 0.7, 1.15)
    dark = hair.mean() < 140 or rng.random() < 0.5
    brows = hair * between(rng, 0.4, 1.05) if dark else np.asarray(_HAIR[rng.integers(4)][1], float)
    lips = skin * [between(rng, 0.72, 1), between(rng, 0.45, 0.8), between(rng, 0.5, 0.85)]
    if rng.random() < 0.2:  # lipstick
        lips = np.array([190, 30, 50]) * between(rng, 0.6, 1.1)
    brown = rng.uniform(15, 140, 3) * [1, 0.9, 0.8]
    iris = brown if rng.random() < 0.7 else np.array([60, 90, 140]) * between(rng, 0.6, 1.4)
    return Palette(skin, hair, brows, np.clip(lips, 0, 255), iris)


def _drawn(rng: np.random.Generator, table) -> NDArray[np.float64]:
    weights = np.array([weight for weight, _ in table])
    return np.asarray(table[rng.choice(len(table), p=weights / weights.sum())][1], float)
