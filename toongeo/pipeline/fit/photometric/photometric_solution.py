"""Where a photometric fit stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats

__all__ = ["PhotometricSolution"]


@dataclass(frozen=True, eq=False)
class PhotometricSolution:
    """Geometry and albedo ``z`` and light (9, 3) at the minimum, and how it was reached."""

    z: Floats
    light: Floats
    landmark_vertices: NDArray[np.int64]
    landmark_loss: float
    prior_loss: float
    loss: float
    residuals: tuple[float, float, float]
    confident_fraction: float
    status: str
    passes: int
    evaluations: int
