"""Lesson 7: light, paint and shape of a picture, told apart as far as they can be."""

import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("07_analysis_by_synthesis")


def test_light_is_nine_numbers_and_found_again(numbers):
    assert numbers["lobe_error"] < 1e-3
    assert numbers["light_error"] < 0.3
    assert numbers["rank"] == 9
    # Of a clamped cosine, degrees 0, 1 and 2 hold 37.5 %, 50 % and 11.7 % of the square.
    assert numbers["left_1"] == pytest.approx(0.625**0.5, abs=0.01)
    assert numbers["left_4"] == pytest.approx(0.125**0.5, abs=0.01)
    assert numbers["left_9"] == pytest.approx(0.0078125**0.5, abs=0.01)


def test_the_loss_is_least_at_the_true_shape(numbers):
    assert all(abs(numbers[f"valley_{mode}"]) < 0.21 for mode in (0, 1, 3))


def test_a_right_gradient_and_a_wrong_one_are_told_apart(numbers):
    assert numbers["taylor_slope"] > 1.9
    assert numbers["wrong_slope"] < 1.2


def test_the_picture_tells_what_landmarks_do_not(numbers):
    assert numbers["photometric_mm"] < 0.4 * numbers["landmarks_mm"] < 0.4 * 0.6 * numbers["mean_mm"]
    assert numbers["astronaut_all"] < numbers["astronaut_light"] < numbers["astronaut_ambient"]


def test_solutions(numbers):
    assert numbers["scale_ambiguity"] < 1e-12
    assert numbers["contrast_decoded"] == pytest.approx(numbers["contrast_true"], rel=0.05)
    assert numbers["contrast_naive"] < 0.7 * numbers["contrast_true"]
