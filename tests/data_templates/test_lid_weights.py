"""The renders that the lid model learns from, and the learning."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "data_templates" / "build"))

import lid_weights
from drawn_eyes import LID_ROWS, with_drawn_eyes
from renders import random_scene

from toongeo.pipeline.parse.lids.find_lids import lid_weights as shipped


@pytest.fixture(scope="module")
def scene():
    return random_scene(np.random.default_rng(3), "cartoon", True, 192, (0.2, 0.25))


def test_the_same_numbers_twice(tmp_path):
    for name in ("a.csv", "b.csv"):
        lid_weights.write_weights(2, tmp_path / name)
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    assert (tmp_path / "a.csv").read_text().startswith(lid_weights.HEADER)


def test_the_shipped_weights_are_of_the_features_that_the_script_trains():
    rng = np.random.default_rng([0, 68])
    render = lid_weights.picture(rng)
    assert lid_weights.case(rng, render, lid_weights.usable_sides(render)[0]).names == shipped().names
    text = (Path(lid_weights.__file__).parents[1] / "lid_weights.csv").read_text(encoding="utf-8")
    assert text.startswith(lid_weights.HEADER)


@pytest.mark.parametrize("seed", range(6))
def test_drawn_lids_enclose_what_was_drawn_and_nothing_else_changes(scene, seed):
    before = scene.picture.copy()
    found = with_drawn_eyes(np.random.default_rng(seed), scene)
    np.testing.assert_array_equal(scene.picture, before)
    lids = np.concatenate(LID_ROWS)
    rest = np.setdiff1d(np.arange(68), [*range(17, 27), *lids])
    np.testing.assert_array_equal(found.landmarks[rest], scene.landmarks[rest])
    changed = np.argwhere((found.picture != before).any(axis=2))[:, ::-1]
    for rows in LID_ROWS:
        eye, width = found.landmarks[rows], np.ptp(scene.landmarks[rows], axis=0).max()
        near = np.linalg.norm(changed - eye.mean(axis=0), axis=1)
        assert near.min() < 2
    middles = np.array([found.landmarks[rows].mean(axis=0) for rows in LID_ROWS])
    away = np.linalg.norm(changed[:, None] - middles, axis=2).min(axis=1)
    assert away.max() < 3 * width


def test_the_order_of_drawn_lids_is_that_of_the_scheme(scene):
    for seed in range(20):
        points = with_drawn_eyes(np.random.default_rng(seed), scene).landmarks
        for rows in LID_ROWS:
            first, *upper, last, low, lower = points[rows]
            across = last - first
            assert across @ (scene.landmarks[rows[3]] - scene.landmarks[rows[0]]) > 0
            assert all(0 < (point - first) @ across < across @ across for point in (*upper, low, lower))
            assert np.mean(upper, axis=0)[1] <= np.mean([low, lower], axis=0)[1] + 1e-9


def test_distances_from_a_closed_polygon():
    square = np.array([[0.0, 0], [2, 0], [2, 2], [0, 2]])
    points = np.array([[[1.0, 1], [3, 1]], [[-3, -4], [0.5, 0.0]]])
    np.testing.assert_allclose(lid_weights.lid_distance(points, square), [[1, 1], [5, 0]])


def test_training_minimises_the_expected_loss_with_its_ridge():
    rng = np.random.default_rng(0)
    features = rng.normal(size=(40, 12, 3)).astype(np.float32)
    loss = (features[..., 0] - 0.5 * features[..., 1] + 2).astype(np.float32) ** 2

    def expected(weights):
        likely = np.exp(features @ weights)
        likely /= likely.sum(axis=1, keepdims=True)
        return (likely * loss).sum(axis=1).mean() + lid_weights.RIDGE * weights @ weights

    found = lid_weights.trained(features, loss)
    for direction in rng.normal(size=(10, 3)):
        assert expected(found + 0.05 * direction) > expected(found)
    assert found[0] < -1 and found[1] > 0.5 and abs(found[2]) < 0.3 * abs(found[0])


def test_disturbed_landmarks_keep_all_but_the_eyes():
    points = np.random.default_rng(1).uniform(0, 300, (68, 2))
    kinds = [lid_weights.disturbed(np.random.default_rng(seed), points) for seed in range(30)]
    lids = np.concatenate(LID_ROWS)
    for moved in kinds:
        np.testing.assert_array_equal(np.delete(moved, lids, axis=0), np.delete(points, lids, axis=0))
    unchanged = sum(np.array_equal(moved, points) for moved in kinds)
    assert 0 < unchanged < 12
