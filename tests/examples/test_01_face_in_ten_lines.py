import pytest

pytestmark = pytest.mark.slow


def test_what_the_lesson_says_holds(numbers_of):
    numbers = numbers_of("01_face_in_ten_lines")
    assert numbers["expressions"] == 46
    assert numbers["detection_error"] < 0.06
    assert numbers["aligned_error"] < 0.25 * numbers["coarse_error"] < 0.25 * 0.1
    assert numbers["sum_gap"] < 1e-3
    assert 0.5 < numbers["chin_down"] < 15
    assert numbers["smile_changes_picture"] > 0.5
