"""Gradient-boosted decision trees as plain arrays (Friedman 2001)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from toongeo._read_only import read_only, restored
from toongeo.arrays import Singles

__all__ = ["BoostedTrees"]


@dataclass(frozen=True, eq=False)
class BoostedTrees:
    """Complete binary trees of one depth d, one for each of c classes and each of t rounds.

    Attributes
    ----------
    features : (t, c, 2^d - 1) uint8
        Column that each inner node looks at, level by level; the children of node i are 2i + 1 and 2i + 2.
    thresholds : (t, c, 2^d - 1) float32
        Rows with a larger value go to the second child.
    leaves : (t, c, 2^d) float
        What is added to the log-odds of the class.
    start : (c,) float
        Log-odds before all trees.
    """

    features: NDArray[np.uint8]
    thresholds: Singles
    leaves: Singles
    start: Singles

    __setstate__ = restored

    def __post_init__(self) -> None:
        inner, ends = self.features.shape[2], self.leaves.shape[2]
        if self.features.shape != self.thresholds.shape or ends != inner + 1 or ends & inner:
            raise ValueError(f"leaves: expected one more than inner nodes, a power of two, got {ends} and {inner}")
        read_only(self, "features", "thresholds", "leaves", "start")

    def __call__(self, X: Singles) -> Singles:
        """Probabilities (n, c) of rows (n, f)."""
        rounds, classes, inner = self.features.shape
        depth = (inner + 1).bit_length() - 1
        columns = np.ascontiguousarray(X.T, np.float32)
        rows = np.arange(len(X))
        score = np.tile(self.start.astype(np.float64), (len(X), 1))
        for t in range(rounds):
            for c in range(classes):
                node = np.zeros(len(X), np.intp)
                feature, threshold = self.features[t, c], self.thresholds[t, c]
                for _ in range(depth):
                    node = 2 * node + 1 + (columns[feature[node], rows] > threshold[node])
                score[:, c] += self.leaves[t, c][node - inner]
        weight = np.exp(score - score.max(axis=1, keepdims=True))
        return (weight / weight.sum(axis=1, keepdims=True)).astype(np.float32)
