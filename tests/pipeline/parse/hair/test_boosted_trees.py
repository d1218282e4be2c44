"""Tests of trees as arrays against trees that are walked."""

import numpy as np
import pytest

from toongeo.pipeline.parse.hair.boosted_trees import BoostedTrees

ROUNDS, CLASSES, DEPTH, COLUMNS = 4, 3, 3, 5


@pytest.fixture
def trees(rng):
    inner = 2**DEPTH - 1
    return BoostedTrees(
        rng.integers(0, COLUMNS, (ROUNDS, CLASSES, inner)).astype(np.uint8),
        rng.normal(size=(ROUNDS, CLASSES, inner)).astype(np.float32),
        rng.normal(size=(ROUNDS, CLASSES, inner + 1)).astype(np.float16),
        rng.normal(size=CLASSES).astype(np.float32),
    )


def walked(trees, row):
    score = trees.start.astype(float).copy()
    for t in range(ROUNDS):
        for c in range(CLASSES):
            node = 0
            for _ in range(DEPTH):
                node = 2 * node + (2 if row[trees.features[t, c, node]] > trees.thresholds[t, c, node] else 1)
            score[c] += trees.leaves[t, c, node - (2**DEPTH - 1)]
    weight = np.exp(score)
    return weight / weight.sum()


def test_rows_fall_through_the_trees_one_by_one(trees, rng):
    X = rng.normal(size=(50, COLUMNS)).astype(np.float32)
    np.testing.assert_allclose(trees(X), [walked(trees, row) for row in X], atol=1e-6)


def test_a_value_at_the_threshold_goes_to_the_first_child(trees, rng):
    row = rng.normal(size=COLUMNS).astype(np.float32)
    row[trees.features[0, 0, 0]] = trees.thresholds[0, 0, 0]
    np.testing.assert_allclose(trees(row[None])[0], walked(trees, row), atol=1e-6)


def test_arrays_that_are_no_complete_trees_are_refused(trees):
    with pytest.raises(ValueError, match="leaves: expected one more than inner nodes"):
        BoostedTrees(trees.features, trees.thresholds, trees.leaves[..., :-1], trees.start)
