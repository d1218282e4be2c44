"""Rest is where a face returns to, however the weights are biased."""

import numpy as np
import pytest

from tests.driving.conftest import smooth_weights
from toongeo.driving.picture.most_usual import most_usual
from toongeo.model.expression_schemes import EXPRESSIONS


@pytest.mark.parametrize("seed", range(5))
def test_rest_is_found_through_errors_that_the_sum_of_weights_takes_for_less(seed):
    """A fifth of the film is at rest; weights are read against a frame that smiles, and some that nobody acts fall
    while a face is lively."""
    rng = np.random.default_rng(seed)
    lively = smooth_weights(rng, EXPRESSIONS[:46], 96)
    acted = np.concatenate([lively[:40], np.zeros((24, 46)), lively[40:]])
    read = acted + rng.normal(0, 0.01, acted.shape)
    read[:, EXPRESSIONS.index("mouthSmileLeft")] -= 0.4
    read[:, ~acted.any(axis=0)] -= 0.1 * acted.sum(axis=1, keepdims=True)
    assert acted[most_usual(read)].sum() == 0 < acted[read.sum(axis=1).argmin()].sum()


def test_neither_a_blink_nor_what_all_weights_share_matters(rng):
    weights = np.concatenate([rng.normal(0, 0.02, (20, 6)), rng.uniform(0, 1, (40, 6))])
    weights[8:11, 0] = 0.5, 1, 0.5
    order = rng.permutation(60)
    assert order[most_usual(weights[order])] in {*range(8), *range(11, 20)}
    assert most_usual(weights + 0.3) == most_usual(weights)


def test_one_frame_is_as_usual_as_can_be():
    assert most_usual(np.ones((1, 3))) == 0
    assert most_usual(np.ones((2, 3))) == 0
