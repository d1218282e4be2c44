import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("02_landmarks_and_procrustes")


def test_the_detector_is_good_where_it_is_sure(numbers):
    assert numbers["sure_astronaut"] == 1 and numbers["error_astronaut"] < 0.05
    assert numbers["sure_bad_guy"] == 0 and numbers["error_bad_guy"] > 0.05
    assert numbers["sure_miss"] < 0.5 * numbers["doubtful_miss"]


def test_held_out_points_tell_a_slip(numbers):
    assert numbers["mouth_alarmed"] > 3 * numbers["mouth_calm"]


def test_alignment_settles(numbers):
    assert numbers["spread_last"] <= numbers["spread_first"]


def test_mirrors_need_new_names(numbers):
    assert numbers["asymmetry_man"] < 0.02 < 0.1 < numbers["asymmetry_threequarter"]
    assert numbers["without_names"] > 0.5
    assert numbers["undone"] < 1e-12


def test_the_other_exercises_come_out(numbers):
    assert numbers["gap_error"] < 1e-9
    assert numbers["shrunk_eyes"] < 0.75 < 0.9 < numbers["shrunk_size"]
