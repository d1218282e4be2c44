"""Tests of the cut against all labelings of small pictures."""

from itertools import product

import numpy as np
import pytest

from toongeo.colour.min_cut import min_cut

STEPS = (((0, 1), 1.0), ((1, 0), 1.0), ((1, 1), 0.7), ((1, -1), 0.7))


def cost(inside, odds, lab, smoothness):
    """What a labeling costs, pixel by pixel, in the integer steps of the cut."""
    height, width = odds.shape
    edges = []
    for (dy, dx), weight in STEPS:
        for y, x in product(range(height), range(width)):
            if 0 <= y + dy < height and 0 <= x + dx < width:
                edges.append(((y, x), (y + dy, x + dx), weight, ((lab[y, x] - lab[y + dy, x + dx]) ** 2).sum()))
    groups = [[e[3] for e in edges if e[2] == w] for w in (1.0, 0.7)]
    # the mean over the four directions, each a mean over its edges
    means = []
    for step, _ in STEPS:
        means.append(np.mean([e[3] for e in edges if (e[1][0] - e[0][0], e[1][1] - e[0][1]) == step]))
    assert all(groups)
    spread = 2 * np.mean(means) + 1e-6
    total = 0
    for one, two, weight, difference in edges:
        if inside[one] != inside[two]:
            total += int(smoothness * weight * np.exp(-difference / spread) * 20 + 1)
    return total + np.rint(np.where(inside, -odds, odds) * 20).clip(0).sum()


@pytest.mark.parametrize("sure", [100.0, 1.0])
def test_no_labeling_is_cheaper(rng, sure):
    for _ in range(6):
        odds = rng.normal(0, 0.8, (3, 3)).astype(np.float32)
        lab = rng.uniform(0, 60, (3, 3, 3)).astype(np.float32)
        found = min_cut(odds, lab, 0.5, sure)
        masks = [np.array(bits, bool).reshape(3, 3) for bits in product((False, True), repeat=9)]
        assert cost(found, odds, lab, 0.5) == min(cost(mask, odds, lab, 0.5) for mask in masks)


def test_the_border_runs_where_the_colour_changes():
    lab = np.zeros((20, 30, 3), np.float32)
    lab[:, 13:, 0] = 60
    odds = np.full((20, 30), 0.05, np.float32)
    odds[:, :3], odds[:, 27:] = 5, -5
    found = min_cut(odds, lab, 6.0, 4.0)
    np.testing.assert_array_equal(found, np.broadcast_to(np.arange(30) < 13, (20, 30)))


def test_settled_pixels_give_the_same_cut_as_all(rng):
    """Leaving out what is sure and far from doubt changes nothing in a smooth field."""
    y, x = np.mgrid[:40, :50]
    odds = (14 - np.hypot(y - 20, x - 25) + rng.normal(0, 0.5, (40, 50))).astype(np.float32)
    lab = rng.uniform(0, 10, (40, 50, 3)).astype(np.float32)
    np.testing.assert_array_equal(min_cut(odds, lab, 1.0, 3.0), min_cut(odds, lab, 1.0, 1e6))


def test_the_settled_side_pulls_at_the_doubtful_one():
    """A line of doubt in a settled field takes the field's side: its borders to what is left out count."""
    odds = np.full((15, 24), 5.0, np.float32)
    odds[:, 11] = -0.2
    lab = np.zeros((15, 24, 3), np.float32)
    assert min_cut(odds, lab, 1.0, 0.1).all() and not min_cut(-odds, lab, 1.0, 0.1).any()
    assert min_cut(odds, lab, 1.0, 1e6).all()


def test_a_picture_of_one_side_stays_so():
    lab = np.zeros((8, 9, 3), np.float32)
    assert not min_cut(np.full((8, 9), -5.0, np.float32), lab, 6.0, 3.0).any()
    assert min_cut(np.full((8, 9), 5.0, np.float32), lab, 6.0, 3.0).all()
