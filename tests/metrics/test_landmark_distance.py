"""Landmark distance in the crop: closed forms, invariance."""

import numpy as np
import pytest

from toongeo.metrics import face_square, landmark_distance
from toongeo.metrics.landmark_distance import CROP_PX, TABLE_PARTS


@pytest.fixture
def truth(rng):
    return rng.uniform(50, 350, (68, 2))


def test_zero_for_the_truth(truth):
    assert set(landmark_distance(truth, truth).values()) == {0.0}


def test_a_constant_offset_is_exact(truth):
    expected = 5.0 * CROP_PX / face_square(truth)[1]
    assert landmark_distance(truth + [3, -4], truth) == pytest.approx(dict.fromkeys(TABLE_PARTS, expected), rel=1e-12)


def test_each_part_is_the_mean_of_its_points(truth, rng):
    shift = rng.normal(0, 3, truth.shape)
    found = landmark_distance(truth + shift, truth)
    for part, points in TABLE_PARTS.items():
        expected = np.linalg.norm(shift, axis=1)[list(points)].mean() * CROP_PX / face_square(truth)[1]
        assert found[part] == pytest.approx(expected, rel=1e-12)
    counts = {part: len(points) for part, points in TABLE_PARTS.items()}
    weighted = sum(counts[part] * found[part] for part in counts if part != "total")
    assert found["total"] == pytest.approx(weighted / counts["total"], rel=1e-12)


@pytest.mark.parametrize("factor", [1e-4, 0.37, 1e4])
def test_size_and_place_of_the_face_in_its_picture_do_not_matter(truth, rng, factor):
    predicted = truth + rng.normal(0, 3, truth.shape)
    moved = landmark_distance(factor * predicted + [700, -40], factor * truth + [700, -40])
    assert moved == pytest.approx(landmark_distance(predicted, truth), rel=1e-6)


def test_the_square_holds_the_face_and_follows_it(truth):
    corner, side = face_square(truth)
    assert (truth > corner).all() and (truth < corner + side).all()
    moved, twice = face_square(2 * truth + [5, 9])
    assert twice == pytest.approx(2 * side) and moved == pytest.approx(2 * corner + [5, 9])


def test_missing_points_are_left_out(truth):
    holes = truth.copy()
    holes[TABLE_PARTS["nose"]] = np.nan
    found = landmark_distance(truth + [3, 4], holes)
    assert np.isnan(found["nose"]) and found["total"] == pytest.approx(5 * CROP_PX / face_square(holes)[1])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"predicted": np.zeros((67, 2))}, r"predicted: expected finite or NaN values of shape \(68, 2\)"),
        ({"truth": np.full((68, 2), np.inf)}, "truth: expected finite or NaN values"),
        ({"truth": np.ones((68, 2))}, "landmarks: expected points that span a face"),
        ({"truth": np.full((68, 2), np.nan)}, "landmarks: expected points that span a face"),
    ],
)
def test_bad_input_is_named(truth, change, message):
    with pytest.raises(ValueError, match=message):
        landmark_distance(**({"predicted": truth, "truth": truth} | change))


@pytest.mark.parametrize("points", [np.zeros((68, 3)), np.full((68, 2), np.inf)])
def test_a_square_needs_68_points(points):
    with pytest.raises(ValueError, match=r"landmarks: expected finite or NaN values of shape \(68, 2\)"):
        face_square(points)
