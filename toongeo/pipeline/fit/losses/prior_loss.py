"""The prior on the coefficients and its gradient."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from toongeo.arrays import Floats
from toongeo.pipeline.fit.frame.unknowns import Unknowns

__all__ = ["PriorLoss"]


@dataclass(frozen=True, eq=False)
class PriorLoss:
    """Eq. 6 of Pan et al. 2024 without the texture: ``L_reg = w_id |a_id - m|^2 + w_exp |a_exp|^2``.

    The mean m of the identities is zero in the printed equation, and for a model whose mean is that of people.

    Attributes
    ----------
    unknowns : Unknowns
    identity_weight, expression_weight : float
        ``w_id`` and ``w_exp``.
    mean : (n,) float
        The likeliest unknowns; only coefficients count.
    """

    unknowns: Unknowns
    identity_weight: float
    expression_weight: float
    mean: Floats

    def __call__(self, x: Floats) -> tuple[float, Floats]:
        """Value and gradient (n,) at ``x`` (n,)."""
        away = x - self.mean
        weighted = self._weights * away
        return float(weighted @ away), 2 * weighted

    def curvature(self, x: Floats) -> Floats:
        """Diagonal (n,) of the second derivative, which is the same everywhere."""
        return 2 * self._weights

    @cached_property
    def _weights(self) -> Floats:
        weights = np.zeros(self.unknowns.size)
        weights[self.unknowns.identity] = self.identity_weight
        weights[self.unknowns.expression] = self.expression_weight
        return weights
