"""The loss that is minimised."""

from __future__ import annotations

from dataclasses import dataclass

from toongeo.arrays import Floats
from toongeo.pipeline.fit.losses.landmark_loss import LandmarkLoss
from toongeo.pipeline.fit.losses.pitch_prior import PitchPrior
from toongeo.pipeline.fit.losses.prior_loss import PriorLoss

__all__ = ["TotalLoss"]


@dataclass(frozen=True, eq=False)
class TotalLoss:
    """Eq. 3 of Pan et al. 2024 without the photometric term: ``L = w_l L_lan + w_r L_reg + w_n L_nod``."""

    landmark: LandmarkLoss
    prior: PriorLoss
    nod: PitchPrior
    landmark_weight: float
    prior_weight: float
    pitch_weight: float

    def __call__(self, x: Floats) -> tuple[float, Floats]:
        """Value and gradient (n,) at ``x`` (n,)."""
        landmark, landmark_slope = self.landmark(x)
        prior, prior_slope = self.prior(x)
        nod, nod_slope = self.nod(x)
        value = self.landmark_weight * landmark + self.prior_weight * prior + self.pitch_weight * nod
        slope = self.landmark_weight * landmark_slope + self.prior_weight * prior_slope + self.pitch_weight * nod_slope
        return value, slope

    def prior_value(self, x: Floats) -> float:
        """``L_reg + w_n / w_r L_nod`` at ``x`` (n,)."""
        return self.prior(x)[0] + self.pitch_weight / self.prior_weight * self.nod(x)[0]

    def curvature(self, x: Floats) -> Floats:
        """Diagonal (n,) of the Gauss-Newton matrix: what the variables are scaled by."""
        landmark = self.landmark_weight * self.landmark.curvature(x)
        return landmark + self.prior_weight * self.prior.curvature(x) + self.pitch_weight * self.nod.curvature(x)

    def normal(self, x: Floats, *, bent: bool = False) -> tuple[float, Floats, Floats]:
        """Value, gradient (n,) and the Gauss-Newton matrix (n, n) at ``x`` (n,), bent as that of `LandmarkLoss`."""
        value, slope, matrix = self.landmark.normal(x, bent=bent)
        prior, prior_slope = self.prior(x)
        nod, nod_slope, nod_matrix = self.nod.normal(x)
        matrix *= self.landmark_weight
        matrix.ravel()[:: len(x) + 1] += self.prior_weight * self.prior.curvature(x)
        turn = self.landmark.unknowns.rotation
        matrix[turn, turn] += self.pitch_weight * nod_matrix
        slope = self.landmark_weight * slope + self.prior_weight * prior_slope
        slope[turn] += self.pitch_weight * nod_slope
        value = self.landmark_weight * value + self.prior_weight * prior + self.pitch_weight * nod
        return value, slope, matrix
