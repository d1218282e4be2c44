"""Chains of bones on which parts of a mesh swing."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from toongeo._brief_repr import brief_repr

__all__ = ["SpringChains"]


@dataclass(frozen=True, eq=False)
class SpringChains:
    """Chains of bones, and how much each vertex of a mesh follows them; what follows none is still.

    Attributes
    ----------
    joints : (c, k, 3) mm, model frame
        Of each chain from its root to the end of its last bone: k - 1 bones.
    weights : (n, c, k - 1)
        Share of each vertex that a bone takes along, 0..1; their sum is at most 1.
    capsules : (m, 7) mm, model frame
        Balls that were pulled along a line, which the ends of the bones stay out of: two ends (3,) and a radius. They
        move as what the chains hang from.

    Raises
    ------
    ValueError
        If shapes do not fit, a radius is not above 0, or a vertex has shares below 0 or a sum beyond 1.

    Examples
    --------
    >>> SpringChains(np.zeros((1, 2, 3)), np.full((5, 1, 1), 0.5)).bones
    1
    """

    joints: NDArray[np.floating]
    weights: NDArray[np.floating]
    capsules: NDArray[np.floating] = field(default_factory=lambda: np.zeros((0, 7)))

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        if self.joints.ndim != 3 or self.joints.shape[1] < 2 or self.joints.shape[2] != 3:
            raise ValueError(f"joints: expected (c, k >= 2, 3), got {self.joints.shape}")
        c, k = self.joints.shape[:2]
        if self.weights.ndim != 3 or self.weights.shape[1:] != (c, k - 1):
            raise ValueError(f"weights: expected (n, {c}, {k - 1}), got {self.weights.shape}")
        if self.capsules.ndim != 2 or self.capsules.shape[1] != 7:
            raise ValueError(f"capsules: expected (m, 7), got {self.capsules.shape}")
        if not (np.isfinite(self.capsules).all() and (self.capsules[:, 6] > 0).all()):
            raise ValueError("capsules: expected finite numbers with a radius above 0")
        if not np.isfinite(self.joints).all():
            raise ValueError("joints: expected finite numbers")
        total = self.weights.sum((1, 2))
        if not ((self.weights >= 0).all() and (total <= 1 + 1e-6).all()):
            raise ValueError("weights: expected shares of 0..1 whose sum is at most 1 at each vertex")

    @property
    def bones(self) -> int:
        """How many bones all chains have."""
        return self.joints.shape[0] * (self.joints.shape[1] - 1)
