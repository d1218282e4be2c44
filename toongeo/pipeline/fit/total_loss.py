"""The loss that is minimised."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.fit.landmark_loss import LandmarkLoss
from toongeo.pipeline.fit.prior_loss import PriorLoss

__all__ = ["TotalLoss"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TotalLoss:
    """Eq. 3 of Pan et al. 2024 without the photometric term: ``L = w_l L_lan + w_r L_reg``."""

    landmark: LandmarkLoss
    prior: PriorLoss
    landmark_weight: float
    prior_weight: float

    def __call__(self, x: Floats) -> tuple[float, Floats]:
        """Value and gradient (n,) at ``x`` (n,)."""
        landmark, landmark_slope = self.landmark(x)
        prior, prior_slope = self.prior(x)
        value = self.landmark_weight * landmark + self.prior_weight * prior
        return value, self.landmark_weight * landmark_slope + self.prior_weight * prior_slope

    def curvature(self, x: Floats) -> Floats:
        """Diagonal (n,) of the Gauss-Newton matrix: what the variables are scaled by."""
        return self.landmark_weight * self.landmark.curvature(x) + self.prior_weight * self.prior.curvature(x)
