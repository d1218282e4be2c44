import pytest

pytestmark = pytest.mark.slow


def test_what_the_lesson_says_holds(numbers_of):
    numbers = numbers_of("18_bring_your_own_model")
    assert numbers["folder_difference_mm"] < 1e-4
    assert numbers["layout_difference_mm"] < 1e-4
    assert numbers["arrays_difference_mm"] < 1e-4
    assert numbers["outwards"] == numbers["same_landmarks"] == numbers["round_trip"] == 1
    assert numbers["origin_off_mm"] < 1e-6
    assert numbers["template_percent"] < numbers["rigged_percent"] < numbers["yours_percent"]
    assert numbers["expressions"] == 46
    assert numbers["same_person_mm"] < 0.1 < 1 < numbers["mean_instead_mm"]
    assert numbers["exit_code_right"] == 0 < numbers["exit_code_swapped"]
    assert numbers["known_mm"] < 1e-9 < 1 < numbers["stranger_mm"] < numbers["stranger_mean_mm"]
    assert numbers["mean_square"] == pytest.approx(11 * 11 / 12)
    assert numbers["drawn_square"] == pytest.approx(11, rel=0.02)
