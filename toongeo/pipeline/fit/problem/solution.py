"""Where a landmark fit stands: what a pass holds fixed, and what comes out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.protocols import HeadCamera

__all__ = ["PassState", "Solution"]


@dataclass(frozen=True, eq=False)
class Solution:
    """Coefficients (c,) and camera at the minimum, the landmarks of that pose, and how it was reached."""

    coefficients: Floats
    camera: HeadCamera
    landmark_vertices: NDArray[np.int64]
    landmark_loss: float
    prior_loss: float
    prior_weight: float
    loss: float
    status: str
    passes: int
    evaluations: int
    outliers: tuple[int, ...]
    convention: str


@dataclass(frozen=True, eq=False)
class PassState:
    """What a pass holds fixed: landmark vertices (68,), robust weights (k,), ``w_r``, and the upper bounds (n,)."""

    vertices: NDArray[np.int64]
    robust_weight: Floats
    prior_weight: float
    upper: Floats
