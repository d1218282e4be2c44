"""Lesson 9: twenty lines of deformation transfer do what the library does."""

import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("09_deformation_transfer")


def test_twenty_lines_agree_with_the_library(numbers):
    assert numbers["bar_library"] < 1e-9
    assert numbers["face_library_mm"] < 1e-6


def test_what_must_hold_exactly_holds(numbers):
    for name in ("gradient_of_one_triangle", "bar_at_rest", "bar_turned", "linearity", "null_space"):
        assert numbers[name] < 1e-9, name


def test_transferred_bar_turns_as_its_source_and_a_copied_one_does_not(numbers):
    assert abs(numbers["angle_transferred"] - numbers["angle_source"]) < 1
    assert numbers["angle_copied"] < numbers["angle_source"] - 20


def test_faces_open_mouth_and_close_eyes_in_their_own_size(numbers):
    source = numbers["mouth_source"]
    assert numbers["mouth_girl_transferred"] == pytest.approx(source, rel=0.05)
    assert numbers["mouth_man_transferred"] == pytest.approx(source, rel=0.05)
    assert numbers["mouth_girl_copied"] > 1.15 * source
    assert numbers["lids_spread_transferred"] < 0.1 * numbers["lids_spread_copied"]


def test_solutions(numbers):
    assert abs(numbers["rise_twisted"]) < 0.1 < 15 < numbers["rise_aligned"]
    assert numbers["thickening_without_root"] == pytest.approx(4)
    assert numbers["turned_without_root"] > 0.1 > 1e6 * numbers["bar_turned"]
