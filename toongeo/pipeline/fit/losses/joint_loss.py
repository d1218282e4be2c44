"""The loss of several pictures of one person."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.arrays import Floats
from toongeo.pipeline.fit.losses.total_loss import TotalLoss

__all__ = ["JointLoss"]


@dataclass(frozen=True, eq=False)
class JointLoss:
    """Sum of the losses of several pictures (Eq. 3 of Pan et al. 2024 each) with one identity for all.

    The prior of the identity counts once: with the mean of the pictures' weights ``w_r``. It is taken to be a
    sum of a function of the identity and one of the expression.

    Attributes
    ----------
    losses : sequence of TotalLoss
        All with the same unknowns; vectors here are ``[identity, rest of picture 1, rest of picture 2, ...]``.
    """

    losses: Sequence[TotalLoss]

    @property
    def n_identity(self) -> int:
        """Length of the part that the pictures share."""
        return self.losses[0].landmark.unknowns.n_identity

    def part(self, x: NDArray[Any], picture: int) -> NDArray[Any]:
        """Unknowns (n,) of one picture."""
        shared = self.n_identity
        own = self.losses[0].landmark.unknowns.size - shared
        return np.concatenate([x[:shared], x[shared + picture * own :][:own]])

    def joined(self, parts: Sequence[Floats]) -> Floats:
        """Inverse of `part`; the identity is the mean of the pictures'."""
        shared = self.n_identity
        identity = np.mean([part[:shared] for part in parts], axis=0)
        return np.concatenate([identity, *(part[shared:] for part in parts)])

    def __call__(self, x: Floats) -> tuple[float, Floats]:
        """Value and gradient at ``x``."""
        parts = [self.part(x, k) for k in range(len(self.losses))]
        values, slopes = zip(*(loss(part) for loss, part in zip(self.losses, parts, strict=True)), strict=True)
        gradient = self._summed(slopes)
        person = np.zeros_like(parts[0])
        person[: self.n_identity] = x[: self.n_identity]
        prior, slope = self.losses[0].prior(person)
        gradient[: self.n_identity] -= self._surplus * slope[: self.n_identity]
        return sum(values) - self._surplus * prior, gradient

    def curvature(self, x: Floats) -> Floats:
        """Diagonal of the Gauss-Newton matrix."""
        diagonal = self._summed([loss.curvature(self.part(x, k)) for k, loss in enumerate(self.losses)])
        prior = self.losses[0].prior.curvature(self.part(x, 0))[: self.n_identity]
        diagonal[: self.n_identity] -= self._surplus * prior
        return diagonal

    def normal(self, x: Floats, *, bent: bool = False) -> tuple[float, Floats, Floats]:
        """Value, gradient (n,) and the Gauss-Newton matrix (n, n) at ``x`` (n,), bent as that of `LandmarkLoss`."""
        value, gradient = self(x)
        matrix = np.zeros((len(x), len(x)))
        for k, loss in enumerate(self.losses):
            place = self.part(np.arange(len(x)), k)
            matrix[np.ix_(place, place)] += loss.normal(x[place], bent=bent)[2]
        shared = np.arange(self.n_identity)
        matrix[shared, shared] -= self._surplus * self.losses[0].prior.curvature(self.part(x, 0))[: self.n_identity]
        return value, gradient, matrix

    @property
    def _surplus(self) -> float:
        """By how much too much the identity's prior counts in the sum of the losses."""
        weights = [loss.prior_weight for loss in self.losses]
        return sum(weights) - sum(weights) / len(weights)

    def _summed(self, parts: Sequence[Floats]) -> Floats:
        shared = self.n_identity
        return np.concatenate([np.sum([part[:shared] for part in parts], axis=0), *(part[shared:] for part in parts)])
