import pytest

pytestmark = pytest.mark.slow


def test_what_the_lesson_says_holds(numbers_of):
    numbers = numbers_of("13_hair_by_inflation")
    assert numbers["disc_error"] < 0.04
    assert numbers["stencil_difference"] < 1e-12
    assert numbers["sticks_out"] > numbers["dome_sticks_out"] > 0.5 > numbers["still_out"] == 0
    assert numbers["same_as_make_avatar"] == numbers["shared_edges"] == 1
    assert numbers["euler"] == 2
    assert numbers["outline_iou"] > 0.95
    assert abs(numbers["strip_height"] - 2**0.5) < 1e-6
    assert numbers["ring_error_fine"] < 0.3 * numbers["ring_error_coarse"]
    assert abs(numbers["cube_volume"] - 1) < 1e-12
    assert 1 < numbers["hair_litres"] < 5
