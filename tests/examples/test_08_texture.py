"""Lesson 8: colours for what the picture does not show."""

import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("08_texture")


def test_own_diffusion_is_the_library_s(numbers):
    assert numbers["layers_gap"] < 1e-12
    assert numbers["queue_gap"] < 1e-12
    assert numbers["library_gap"] <= 1
    assert numbers["place_gap"] < 1e-3


def test_layers_are_symmetric_and_a_queue_is_not(numbers):
    assert numbers["asymmetry_layers"] == 0
    assert numbers["asymmetry_queue"] > 0.1


def test_a_part_of_the_face_is_hidden_and_the_seen_part_is_the_picture(numbers):
    assert 0.05 < numbers["hidden"] < 0.4
    assert 0.2 < numbers["known_share"] < 0.7
    assert numbers["picture_again"] <= 2


def test_solutions(numbers):
    assert numbers["layers"] == numbers["greatest_distance"]
    assert numbers["smoothest"] < 0.5 * numbers["rough"]
    assert numbers["layers_8"] < numbers["layers_4"]
