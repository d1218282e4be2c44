"""Gradient-boosted trees grown level by level on histograms, for several classes with soft targets."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from toongeo.pipeline.parse.hair.boosted_trees import BoostedTrees

__all__ = ["grow_trees"]

_BINS = 64
_RATE = 0.12
_L2 = 5.0
_LEAST = 3.0  # sum of p (1 - p) that each side of a split must have
_ROWS, _COLUMNS = 0.4, 0.6  # shares that each tree sees (Friedman 2002)


def grow_trees(
    X: NDArray[np.float32], Y: NDArray[np.float32], *, rounds: int, depth: int, rng: np.random.Generator
) -> BoostedTrees:
    """Trees for rows X (n, f) and shares Y (n, c) of the classes, by the softmax loss and Newton steps."""
    classes, inner = Y.shape[1], 2**depth - 1
    edges = [np.unique(np.quantile(column, np.linspace(0, 1, _BINS)[1:-1])).astype(np.float32) for column in X.T]
    codes = np.stack([np.searchsorted(e, column, side="left") for e, column in zip(edges, X.T, strict=True)])
    codes = codes.astype(np.uint8)
    start = np.log(np.maximum(Y.mean(0), 1e-6))
    score = np.tile(start, (len(X), 1))
    features = np.zeros((rounds, classes, inner), np.uint8)
    thresholds = np.full((rounds, classes, inner), np.inf, np.float32)
    leaves = np.zeros((rounds, classes, inner + 1), np.float16)
    for t in range(rounds):
        P = np.exp(score - score.max(1, keepdims=True))
        P /= P.sum(1, keepdims=True)
        for c in range(classes):
            rows = np.flatnonzero(rng.random(len(X)) < _ROWS)
            columns = np.sort(rng.choice(X.shape[1], max(1, round(_COLUMNS * X.shape[1])), replace=False))
            g, h = (P[:, c] - Y[:, c])[rows], (P[:, c] * (1 - P[:, c]))[rows]
            tree = _Tree(depth)
            tree.grow(codes[:, rows], columns, g, h)
            for node, (feature, cell) in tree.splits.items():
                features[t, c, node], thresholds[t, c, node] = feature, edges[feature][cell]
            leaves[t, c] = tree.values
            score[:, c] += leaves[t, c].astype(float)[tree.leaf_of(codes)]
    return BoostedTrees(features, thresholds, leaves, start.astype(np.float32))


class _Tree:
    def __init__(self, depth: int) -> None:
        self.depth = depth
        self.splits: dict[int, tuple[int, int]] = {}
        self.values = np.zeros(2**depth, np.float16)

    def grow(self, codes: NDArray[np.uint8], columns: NDArray[np.int64], g, h) -> None:
        node = np.zeros(codes.shape[1], np.intp)
        for level in range(self.depth):
            first, count = 2**level - 1, 2**level
            base = (node - first) * _BINS
            best = np.full(count, 1e-9)
            found: dict[int, tuple[int, int]] = {}
            for f in columns:
                at = base + codes[f]
                G, H = (np.bincount(at, w, count * _BINS).reshape(count, _BINS).cumsum(1) for w in (g, h))
                gain = G**2 / (H + _L2) + (G[:, -1:] - G) ** 2 / (H[:, -1:] - H + _L2) - (G**2 / (H + _L2))[:, -1:]
                gain[(H < _LEAST) | (H[:, -1:] - H < _LEAST)] = -1
                cell = gain.argmax(1)
                for k in np.flatnonzero(gain[np.arange(count), cell] > best):
                    best[k], found[first + int(k)] = gain[k, cell[k]], (int(f), int(cell[k]))
            self.splits |= found
            node = self._step(codes, node)
        leaf = node - (2**self.depth - 1)
        G, H = (np.bincount(leaf, w, 2**self.depth) for w in (g, h))
        self.values = (-_RATE * G / (H + _L2)).astype(np.float16)

    def _step(self, codes: NDArray[np.uint8], node: NDArray[np.intp]) -> NDArray[np.intp]:
        feature = np.zeros(2**self.depth - 1, np.intp)
        cell = np.full(2**self.depth - 1, 255, np.intp)
        for k, (f, c) in self.splits.items():
            feature[k], cell[k] = f, c
        return 2 * node + 1 + (codes[feature[node], np.arange(len(node))] > cell[node])

    def leaf_of(self, codes: NDArray[np.uint8]) -> NDArray[np.intp]:
        node = np.zeros(codes.shape[1], np.intp)
        for _ in range(self.depth):
            node = self._step(codes, node)
        return node - (2**self.depth - 1)
