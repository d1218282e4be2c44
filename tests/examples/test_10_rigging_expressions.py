"""Lesson 10: a rig is a matrix, and what it must not do is seen to."""

import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("10_rigging_expressions")


def test_sums_and_spheres_are_exact(numbers):
    assert numbers["sum_gap"] < 1e-4
    assert numbers["recovered"] < 1e-4 < numbers["recovered_few"]
    assert numbers["sphere_error"] < 1e-9
    assert numbers["gaze_gap"] < 1e-9
    assert numbers["mirror_gap_mm"] < 1e-6


def test_contact_is_made_after_the_transfer(numbers):
    assert numbers["lids_shut_mm"] < 0.2 * numbers["lids_shut_raw_mm"] < 0.2 * numbers["lids_open_mm"]
    assert numbers["lips_sealed_mm"] < 0.5 * numbers["lips_sealed_raw_mm"] < 0.1 * numbers["lips_open_mm"]
    assert numbers["closure_left"] > 99


def test_lids_stay_outside_of_the_eyeball_on_the_whole_way(numbers):
    assert numbers["lids_nearest_transferred"] < 0.98
    assert numbers["lids_nearest_finished"] > 1


def test_half_of_the_knobs_would_hold_the_motion(numbers):
    assert 10 < numbers["directions"] < 30
