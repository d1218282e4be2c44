import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("04_cameras_and_pose")


def test_perspective_fades_like_one_over_the_distance(numbers):
    assert numbers["gap_near_mm"] > 20 > 5 > numbers["gap_far_mm"]
    assert numbers["gap_ratio"] == pytest.approx(2500 / 1200, rel=0.15)


def test_a_three_quarter_view_is_turned(numbers):
    assert numbers["yaw_girl"] < -5 and numbers["yaw_girl_fit"] < -5


def test_a_nod_can_be_imitated_by_ordinary_people_and_turns_cannot(numbers):
    assert numbers["nod_imitated"] > 0.7 and numbers["nod_deviations"] < 3
    assert max(numbers["shake_imitated"], numbers["tilt_imitated"]) < 0.6


def test_sliding_points_give_the_pose_and_fixed_ones_do_not(numbers):
    assert numbers["yaw_error_sliding"] < 0.5
    assert numbers["yaw_error_fixed"] > 10


def test_the_exercises_come_out(numbers):
    assert numbers["mirror_miss"] < 1e-12 and numbers["mirror_looks"] < 0
    assert numbers["plate_gap"] < 1e-9
    assert numbers["distance_given"] == pytest.approx(500, rel=0.05)
    assert numbers["distance_found"] == pytest.approx(500, rel=0.5)
