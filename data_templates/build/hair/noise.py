"""Random fields and lines from which pictures are painted."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Rng = np.random.Generator

__all__ = ["Floats", "Rng", "chance", "clouds", "rounded", "smooth_field", "wavy"]


def chance(rng: Rng, probability: float) -> bool:
    return bool(rng.random() < probability)


def smooth_field(rng: Rng, shape: tuple[int, int], knots: int) -> Floats:
    """Smooth field (h, w) of standard deviation about 1 from random values at ``knots`` x ``knots`` points."""
    coarse = rng.normal(size=(knots, knots)).astype(np.float32)
    return np.asarray(cv2.resize(coarse, shape[::-1], interpolation=cv2.INTER_CUBIC), np.float32)


def clouds(rng: Rng, shape: tuple[int, int], roughness: float) -> Floats:
    """Fractal field (h, w) of standard deviation 1: octaves that fall by ``roughness``, as in natural pictures."""
    field, knots, weight = np.zeros(shape, np.float32), 3, 1.0
    while knots < max(shape):
        field += np.float32(weight) * smooth_field(rng, shape, knots)
        knots, weight = knots * 2, weight * roughness
    return field / max(float(field.std()), 1e-6)


def wavy(rng: Rng, x: Floats, waves: int, fall: float = 0.7) -> Floats:
    """Random periodic function of angles x, about unit amplitude: a Fourier series whose terms fall."""
    total = np.zeros_like(x, np.float32)
    for k in range(1, waves + 1):
        total += np.float32(fall ** (k - 1)) * np.sin(k * x + np.float32(rng.uniform(0, 2 * np.pi))).astype(np.float32)
    return total * np.float32(np.sqrt(1 - fall**2))


def rounded(polygon: NDArray[np.float64], passes: int = 2) -> NDArray[np.float64]:
    """A closed polygon (k, 2) with its corners cut (Chaikin 1974)."""
    for _ in range(passes):
        after = np.roll(polygon, -1, axis=0)
        polygon = np.stack([0.75 * polygon + 0.25 * after, 0.25 * polygon + 0.75 * after], axis=1).reshape(-1, 2)
    return polygon
