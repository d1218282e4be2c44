"""The renders that hair is learned from, and the trees that learn it."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "data_templates" / "build" / "hair"))

from grow_trees import grow_trees
from random_hair import random_hair
from random_hat import random_hat
from random_head import random_head
from random_picture import HAIR, random_picture


@pytest.fixture(scope="module")
def pictures(model):
    return [random_picture(np.random.default_rng(k), model) for k in range(12)]


def test_a_seed_gives_the_same_picture_again(pictures, model):
    again = random_picture(np.random.default_rng(3), model)
    np.testing.assert_array_equal(again.img, pictures[3].img)
    np.testing.assert_array_equal(again.labels, pictures[3].labels)


def test_pictures_show_hair_and_bald_heads(pictures):
    shares = np.array([(p.labels == HAIR).mean() for p in pictures])
    assert (shares > 0.02).sum() >= 4 and (shares == 0).any()


def test_hats_lie_on_the_head_and_leave_no_hair_above_their_rim(model):
    for seed in range(8):
        rng = np.random.default_rng(seed)
        head = random_head(rng, model, 300, 0.0)
        hat = random_hat(rng, head, np.full(3, 90, np.float32))
        assert (hat.mask & head.skull).sum() > 0.05 * head.skull.sum()
        assert (hat.mask & (head.up > 0.3)).sum() > 0.5 * (head.skull & (head.up > 0.3)).sum()
        hair = random_hair(rng, head, 0.0).below(head.up, hat.rim)
        assert not ((hair.front | hair.behind) & (head.up >= hat.rim)).any()


def test_landmarks_lie_in_the_picture_and_mostly_not_on_hair(pictures):
    for p in pictures:
        height, width = p.labels.shape
        x, y = np.rint(p.landmarks[17:]).astype(int).T
        assert (x >= 0).all() and (y >= 0).all() and (x < width).all() and (y < height).all()
        assert (p.labels[y, x] != 0).mean() < 0.6


def test_a_head_lies_where_its_landmarks_are(model):
    head = random_head(np.random.default_rng(1), model, 300, 0.0)
    x, y = np.rint(head.landmarks[27:36]).astype(int).T
    assert head.face[y, x].all()
    crown, chin = head.place(np.array([[0, 0.38], [0, -0.62]]))
    assert np.linalg.norm(crown - chin) == pytest.approx(head.size)
    assert np.linalg.norm(chin - head.landmarks[8]) < 0.15 * head.size


def test_trees_learn_what_no_line_parts(rng):
    """Exclusive or of two columns, one class more for the third column, and a column of noise."""
    X = rng.uniform(-1, 1, (3000, 4)).astype(np.float32)
    label = np.where(X[:, 2] > 0.5, 2, (X[:, 0] > 0) ^ (X[:, 1] > 0))
    trees = grow_trees(X, np.eye(3, dtype=np.float32)[label], rounds=40, depth=3, rng=np.random.default_rng(0))
    fresh = rng.uniform(-1, 1, (1000, 4)).astype(np.float32)
    truth = np.where(fresh[:, 2] > 0.5, 2, (fresh[:, 0] > 0) ^ (fresh[:, 1] > 0))
    assert (trees(fresh).argmax(1) == truth).mean() > 0.95


def test_trees_of_one_value_give_its_share(rng):
    X = np.zeros((500, 2), np.float32)
    Y = np.tile(np.float32([0.7, 0.3]), (500, 1))
    trees = grow_trees(X, Y, rounds=5, depth=2, rng=np.random.default_rng(0))
    np.testing.assert_allclose(trees(X[:1])[0], [0.7, 0.3], atol=1e-4)
