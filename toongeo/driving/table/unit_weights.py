"""Weights in the unit of ours."""

from __future__ import annotations

import numpy as np

from toongeo.arrays import Floats

__all__ = ["LARGEST", "unit_weights"]

LARGEST = 5.0  # no expression is meant to be played five times; Unity, Maya and Audio2Face write 0..100


def unit_weights(weights: Floats, what: str) -> tuple[Floats, tuple[str, ...]]:
    """Weights of which 1 is the full expression, from such or from percent; and a note if they were percent.

    Raises
    ------
    ValueError
        If they are too large for percent.
    """
    most = float(np.abs(weights).max(initial=0.0))
    if most <= LARGEST:
        return weights, ()
    if most > 100 * LARGEST:
        raise ValueError(f"{what}: expected weights of 0 to 1, or percent, got up to {most:.4g}")
    return weights / 100, (f"weights of up to {most:.4g} were taken for percent",)
