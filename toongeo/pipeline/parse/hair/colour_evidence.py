"""What a pixel's colour says about two sides of a picture."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter

from toongeo.arrays import Singles

__all__ = ["colour_evidence"]


_LEVELS = 16  # a channel
_STEP = 8.0  # CIELAB units a level
_BLUR = 0.7  # levels
_FLOOR = 2e-5  # share of a colour that neither side shows


def colour_evidence(lab: Singles, inside: Singles, outside: Singles) -> Singles:
    """Log ratio (h, w) of two colour histograms of a CIELAB picture (h, w, 3), by weights (h, w) of its pixels."""
    cell = np.clip((lab + np.array([0, 64, 64], np.float32)) / _STEP, 0, _LEVELS - 1).astype(np.intp)
    codes = ((cell[..., 0] * _LEVELS + cell[..., 1]) * _LEVELS + cell[..., 2]).ravel()
    shares = []
    for weights in (inside, outside):
        counts = np.bincount(codes, weights.ravel(), _LEVELS**3).reshape((_LEVELS,) * 3)
        smooth = gaussian_filter(counts, _BLUR, mode="constant")
        shares.append(smooth / max(float(smooth.sum()), 1e-6) + _FLOOR)
    return np.log(shares[0] / shares[1]).ravel()[codes].reshape(lab.shape[:2]).astype(np.float32)
