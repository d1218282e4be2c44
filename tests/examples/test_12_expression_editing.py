"""Lesson 12: a drawing with another expression, and nothing else of it changed."""

import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("12_expression_editing")


def test_what_does_not_move_does_not_change(numbers):
    assert numbers["warp_still"] <= 1
    assert numbers["touched_outside"] == 0
    assert numbers["outside_share"] > 0.1
    assert numbers["texture_kept"] < 3
    assert numbers["back_to_the_drawing"] < 0.01


def test_own_lines_agree_with_the_library(numbers):
    assert numbers["compose_gap"] < 1e-3
    assert numbers["attention_gap"] < 0.06  # the library's is smoothed


def test_a_wink_stays_on_its_side(numbers):
    assert 300 < numbers["wink_pixels"] < 10_000
    assert numbers["wink_other_half"] == 0


def test_landmarks_of_an_edit_are_affine_in_the_weights(numbers):
    assert numbers["uneven_px"] < 1e-3
    assert numbers["corner_up_px"] > 5


def test_a_generator_of_ones_own_paints(numbers):
    assert numbers["blush"] > 1
    assert 0.2 < numbers["keep_difference"] < 10
