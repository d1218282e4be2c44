"""The colour of skin in one picture, which changes slowly over the face.

Constants were chosen by eye on the seven examples and 15 caricatures.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats

__all__ = ["SkinSurface", "colour_mode", "skin_surface"]

_PASSES = 6
_TIGHTEST, _LOOSEST = 4.0, 14.0  # Lab units: what skin may scatter
_NEAR = 0.35  # of the patch's side: how fast weights fall off from its centre
_STIFFNESS = np.array([0.01, 0.05, 0.05, 0.05, 0.05, 0.05])  # against leaving the seed, for 1, x, y, x², xy, y²


@dataclass(frozen=True, eq=False)
class SkinSurface:
    """Expected colour of skin at each pixel.

    Attributes
    ----------
    colour : (h, w, 3) float
        CIELAB.
    spread : float
        Lab units; how far skin scatters about it.
    """

    colour: Floats
    spread: float


def skin_surface(lab: NDArray[np.floating], seed: Floats, support: NDArray[np.bool_]) -> SkinSurface:
    """Quadratic surface through the skin of a patch, fitted robustly (Welsch weights) from one colour.

    Shading bends the surface; eyes, strokes and hair are too far off to count.

    Parameters
    ----------
    lab : (h, w, 3) float
        CIELAB.
    seed : (3,)
        A colour of skin.
    support : (h, w) bool
        Pixels that may be skin.
    """
    height, width = lab.shape[:2]
    y, x = (np.mgrid[:height, :width] - np.array([height - 1, width - 1])[:, None, None] / 2) * 2 / max(width, 1)
    place = np.exp(-0.5 * (x**2 + y**2) / (2 * _NEAR) ** 2)
    inside = support.ravel()
    rows = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=2).reshape(-1, 6)
    basis, weight = rows[inside], place.ravel()[inside]
    colours = lab.reshape(-1, 3)[inside].astype(np.float64) - seed
    coefficients, spread = np.zeros((6, 3)), _LOOSEST
    for _ in range(_PASSES):
        error = ((colours - basis @ coefficients) ** 2).sum(axis=1)
        weighted = (weight * np.exp(-0.5 * error / spread**2))[:, None] * basis
        stiffness = np.diag(_STIFFNESS) * (weighted[:, 0].sum() + 1.0)
        coefficients = np.linalg.solve(weighted.T @ basis + stiffness, weighted.T @ colours)
        distance = np.sqrt(((colours - basis @ coefficients) ** 2).sum(axis=1))
        near = distance[(distance < 2.5 * spread) & (weight > 0.05)]
        spread = float(np.clip(1.2 * np.median(near), _TIGHTEST, _LOOSEST)) if len(near) > 20 else 5.0
    return SkinSurface(seed + (rows @ coefficients).reshape(height, width, 3), spread)


def colour_mode(colours: Floats, spread: float = 10.0) -> Floats:
    """Commonest of some colours (k, 3): mean shift from their median."""
    mode = np.median(colours, axis=0)
    for _ in range(12):
        weight = np.exp(-0.5 * ((colours - mode) ** 2).sum(axis=1) / spread**2) + 1e-9
        mode = weight @ colours / weight.sum()
    return mode
