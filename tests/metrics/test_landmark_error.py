"""Landmark error: closed forms, missing points, invariance."""

import numpy as np
import pytest

from toongeo.metrics.landmark_error import IBUG68_PARTS, landmark_error


@pytest.fixture(params=[2, 3])
def truth(request):
    return np.random.default_rng(0).normal(0, 50, (68, request.param))


def test_parts_cover_the_68_points_once():
    main = [index for part in ("jaw", "brow", "nose", "eyes", "mouth") for index in IBUG68_PARTS[part]]
    assert sorted(main) == list(range(68))
    assert list(IBUG68_PARTS["jaw"]) + list(IBUG68_PARTS["inner51"]) == list(IBUG68_PARTS["total"])


def test_each_part_is_the_root_mean_square_over_the_outer_eye_distance(truth):
    shift = np.random.default_rng(1).normal(0, 1, truth.shape)
    errors = landmark_error(truth + shift, truth)
    scale = np.linalg.norm(truth[36] - truth[45])
    for name, part in IBUG68_PARTS.items():
        expected = np.sqrt((shift[list(part)] ** 2).sum() / len(part)) / scale
        assert errors[name] == pytest.approx(expected, rel=1e-12)


def test_zero_for_the_truth_and_parts_are_independent(truth):
    assert set(landmark_error(truth, truth).values()) == {0.0}
    moved = truth.copy()
    moved[30] += 1
    assert {name for name, error in landmark_error(moved, truth).items() if error} == {
        "nose",
        "inner51",
        "total",
    }


@pytest.mark.parametrize("factor", [1e-4, 1e4])
def test_scale_does_not_matter(truth, factor):
    predicted = truth + np.random.default_rng(1).normal(0, 1, truth.shape)
    result = landmark_error(factor * predicted, factor * truth)
    assert result == pytest.approx(landmark_error(predicted, truth), rel=1e-9)


def test_missing_rows_are_left_out(truth):
    predicted = truth + 1.0
    holes, expected = truth.copy(), landmark_error(predicted, truth)
    holes[[0, 20], 0] = np.nan
    predicted[50] = np.nan
    assert landmark_error(predicted, holes) == pytest.approx(expected)
    holes[:17] = np.nan
    assert np.isnan(landmark_error(predicted, holes)["jaw"])


def test_own_parts_and_scale():
    errors = landmark_error([[3.0, 4]], [[0.0, 0]], parts={"only": [0], "none": []}, scale=10)
    assert errors["only"] == 0.5 and np.isnan(errors["none"])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"predicted": np.zeros((67, 2))},
            r"predicted: expected shape \(68, 2\) as truth has, got \(67, 2\)",
        ),
        ({"predicted": np.zeros(68)}, r"predicted: expected shape \(k, 2\) or \(k, 3\), got \(68,\)"),
        ({"predicted": np.full((68, 2), np.inf)}, "predicted: expected finite values or NaN"),
        ({"truth": np.zeros((68, 4))}, r"truth: expected shape \(k, 2\) or \(k, 3\)"),
        (
            {"truth": np.zeros((68, 2))},
            r"truth: expected two different outer eye corners \(points \(36, 45\)\)",
        ),
        ({"truth": np.full((68, 2), np.nan)}, "truth: expected two different outer eye corners"),
        ({"scale": 0.0}, r"scale: expected a finite number above 0, got 0\.0"),
        ({"scale": np.nan}, "scale: expected a finite number above 0, got nan"),
        ({"parts": {"chin": [68]}}, r"parts\['chin'\]: expected indices below 68, got up to 68"),
    ],
)
def test_bad_input_is_named(change, message):
    points = np.random.default_rng(0).random((68, 2))
    with pytest.raises(ValueError, match=message):
        landmark_error(**({"predicted": points, "truth": points} | change))


def test_few_points_need_a_scale():
    with pytest.raises(ValueError, match="truth: expected the 68 points of iBUG or a `scale`, got 5 points"):
        landmark_error(np.zeros((5, 2)), np.zeros((5, 2)), parts={"all": range(5)})
