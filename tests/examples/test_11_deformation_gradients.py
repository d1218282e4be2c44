"""Lesson 11: rotations and stretches can be extrapolated where displacements cannot."""

import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("11_deformation_gradients")


def test_own_lines_agree_with_the_library(numbers):
    assert numbers["affine_error"] < 1e-9
    for name in ("own_polar", "own_log", "own_exp", "own_round_trip"):
        assert numbers[name] < 1e-9, name
    assert numbers["gradient_gap"] < 0.01  # the library lets neighbours have a say
    assert numbers["angle_error_degrees"] < 3


def test_twice_a_bend_keeps_the_length(numbers):
    assert numbers["length_library"] == pytest.approx(20, abs=0.05)
    assert numbers["length_own_lines"] == pytest.approx(20, abs=0.1)
    assert numbers["length_displacements"] > 25
    assert numbers["half_turned"] == pytest.approx(20, abs=0.05)
    assert numbers["half_moved"] < 13


def test_a_jaw_that_turns_swells_less(numbers):
    assert numbers["jaw_growth_turned"] < 0.5 * numbers["jaw_growth_moved"]


@pytest.mark.parametrize("name", ["moustache_man", "blue_girl"])
def test_only_the_space_meets_landmarks_with_a_face(numbers, name):
    assert numbers[f"{name}_prior_missed"] > 3
    assert numbers[f"{name}_prior_folds"] < 5
    assert numbers[f"{name}_free_missed"] < 1
    assert numbers[f"{name}_free_folds"] > 500
    assert numbers[f"{name}_space_missed"] < 0.01
    assert numbers[f"{name}_space_folds"] < 30


def test_exaggeration_goes_away_from_the_mean(numbers):
    assert numbers["unlike_0"] < 0.5 * numbers["unlike_1"] < 0.3 * numbers["unlike_2"]


def test_solutions(numbers):
    assert numbers["same_axis"] < 1e-12
    # Baker, Campbell and Hausdorff: half the product of the angles, to second order.
    assert numbers["other_axis_degrees"] == pytest.approx(30 * 0.5236 / 2, rel=0.05)
    assert numbers["taylor_slope"] > 1.9
    assert numbers["best_weight"] == pytest.approx(1, abs=0.011)
