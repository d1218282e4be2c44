"""Colours of skin and hair, and how often the default head's appearances have them.

``skin_tones.csv`` gives a and b for each lightness and names its sources. The spread of a and b about that
line is chosen within the spread in a group of Xiao et al. (Skin Res. Technol. 23 (2017) 21-29: about 2.2 and
1.8). How often a tone, a beard or a flush occurs, and the colours of hair, were chosen by eye: they are no
statistic of any population.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_WHITE = np.array([0.95047, 1.0, 1.08883])  # D65
_XYZ_TO_RGB = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])


def lab_to_srgb(lab: Array) -> Array:
    """CIELAB (..., 3) under D65 to sRGB, clipped to [0, 1]."""
    fy = (lab[..., 0] + 16) / 116
    f = np.stack([fy + lab[..., 1] / 500, fy, fy - lab[..., 2] / 200], -1)
    xyz = np.where(f > 6 / 29, f**3, 3 * (6 / 29) ** 2 * (f - 4 / 29)) * _WHITE
    linear = np.clip(xyz @ _XYZ_TO_RGB.T, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def skin_tone(lightness: Array | float) -> Array:
    """CIELAB (..., 3) of skin of the given L, by linear interpolation in ``skin_tones.csv``."""
    with open(Path(__file__).parent / "skin_tones.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    known = np.array([[float(r[k]) for k in "Lab"] for r in rows])
    lightness = np.asarray(lightness, float)
    a, b = (np.interp(lightness, known[:, 0], known[:, k]) for k in (1, 2))
    return np.stack([lightness, a, b], -1)


def draw_appearance(rng: np.random.Generator) -> dict[str, float]:
    """One random appearance: the skin in CIELAB, the rest as the amounts that `albedo` paints with."""
    tone = float(np.clip(rng.normal(67.5, 10.0), 30.0, 82.0))
    dark_hair = float(np.clip(rng.beta(2.0, 1.3) + 0.35 * np.clip((60 - tone) / 25, 0, 1), 0.05, 1.0))
    return {
        "tone": tone,
        "red": rng.normal(0.0, 1.6),
        "yellow": rng.normal(0.0, 1.6),
        "flush": float(np.clip(rng.normal(0.75, 0.35), 0.0, 1.8)),
        "lip_red": rng.normal(8.5, 2.5),
        "lip_dark": rng.normal(8.0, 2.2),
        "lid": float(np.clip(rng.normal(0.8, 0.45), 0.0, 2.0)),
        "brow": rng.uniform(0.7, 1.0),
        "dark_hair": dark_hair,
        "red_hair": rng.beta(1.0, 4.0),
        "beard": rng.beta(1.2, 2.0) if rng.random() < 0.5 else 0.0,
    }


def hair_colour(dark: float, red: float) -> Array:
    """sRGB (3,) of hair from fair (dark = 0) to black (1); `red` warms it. Chosen by eye."""
    lab = np.array([np.interp(dark, [0, 0.5, 1], k) for k in ([58, 32, 16], [6, 7, 2], [22, 14, 4])], float)
    return lab_to_srgb(lab + red * (1 - 0.7 * dark) * np.array([-4.0, 12.0, 8.0]))
