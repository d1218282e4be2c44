"""Shapes of drawn eyes and their lids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from renders.canvas import between

__all__ = ["SAMPLES", "DrawnEye", "landmark_samples", "lid_ring", "random_eye"]

Floats = NDArray[np.float64]

SAMPLES = 24  # of a lid
_SHAPES = ("almond", "oval", "half", "manga", "shut", "dot")
_CHANCES = (0.40, 0.14, 0.12, 0.18, 0.10, 0.06)


@dataclass(frozen=True, eq=False)
class DrawnEye:
    """How both eyes of a face are drawn; lengths are shares of an eye's width, `across` of the rendered eye's.

    `upper` and `lower` are the heights of the lids, `peak` in (-1, 1) where they are highest, `square` the exponent
    of their curves, `tilt` the rise of the outer corner, `iris` its radius, `gaze` (2,) its place. `lash`, `under` and
    `crease` are the thickness of the upper and lower line and of the one above, 0 where there is none; `outwards` how
    far the upper line lies outside the lid, in its own thickness; `spikes` the number of lashes.
    """

    shape: str
    across: float
    upper: float
    lower: float
    peak: float
    square: float
    tilt: float
    iris: float
    gaze: Floats
    lash: float
    under: float
    crease: float
    outwards: float
    spikes: int


def random_eye(rng: np.random.Generator) -> DrawnEye:
    """One of six shapes, with its lines."""
    shape = str(rng.choice(_SHAPES, p=_CHANCES))
    wide = {"almond": (0.8, 1.5), "oval": (0.5, 1.1), "half": (0.9, 1.6), "manga": (1.0, 1.7), "shut": (0.7, 1.4)}
    upper = {"almond": (0.12, 0.5), "oval": (0.5, 1.2), "half": (0.0, 0.12), "manga": (0.3, 0.75), "shut": (-0.2, 0.3)}
    lower = {"almond": (0.08, 0.4), "oval": (0.5, 1.2), "half": (0.3, 0.7), "manga": (0.25, 0.7), "shut": (0, 0)}
    low = between(rng, *lower.get(shape, (0.4, 0.6)))
    high = between(rng, *upper.get(shape, (0.4, 0.6)))
    if shape == "oval":
        high = low * between(rng, 0.85, 1.2)
    if shape == "shut":
        low = -high
    round_ = shape in ("oval", "dot")
    big = shape == "manga" or (shape == "almond" and rng.random() < 0.4)
    return DrawnEye(
        shape=shape,
        across=between(rng, 0.25, 0.5) if shape == "dot" else between(rng, *wide[shape]),
        upper=high,
        lower=low,
        peak=0.0 if round_ else between(rng, -0.35, 0.35),
        square=2.0 if round_ else between(rng, 1.6, 3.5),
        tilt=between(rng, -0.08, 0.15),
        iris=(0.8 if big else 0.5) * (high + low) * between(rng, 0.6, 1.1),
        gaze=rng.normal(0, [0.10, 0.05]),
        lash=between(rng, 0.03, 0.16) if rng.random() < 0.9 else 0.0,
        under=between(rng, 0.015, 0.08) if rng.random() < 0.6 else 0.0,
        crease=between(rng, 0.015, 0.05) if rng.random() < 0.5 else 0.0,
        outwards=between(rng, -0.1, 0.5),
        spikes=int(rng.integers(3, 10)) if rng.random() < 0.25 else 0,
    )


def lid_ring(eye: DrawnEye, outer: int) -> Floats:
    """Closed contour (48, 2) in widths, x to the right and y up, from the left corner over the upper lid and back.

    `outer` is the direction of the outer corner.
    """
    x = np.linspace(-1, 1, SAMPLES + 1)
    if eye.shape in ("oval", "dot"):  # samples are even along an ellipse, not across it
        x = -np.cos(np.linspace(0, np.pi, SAMPLES + 1))
    skewed = x - outer * eye.peak * (1 - x**2)
    bulge = np.maximum(1 - np.abs(skewed) ** eye.square, 0) ** (1 / (2 if eye.square == 2.0 else 1))
    slope = outer * eye.tilt * x / 2
    upper = np.column_stack([x / 2, eye.upper * bulge + slope])
    lower = np.column_stack([x / 2, -eye.lower * bulge + slope])
    return np.vstack([upper[:-1], lower[:0:-1]])


def landmark_samples() -> NDArray[np.int64]:
    """Which samples of the ring are the six landmarks: corners, and thirds of either lid."""
    third = SAMPLES // 3
    return np.array([0, third, 2 * third, SAMPLES, SAMPLES + third, SAMPLES + 2 * third])
