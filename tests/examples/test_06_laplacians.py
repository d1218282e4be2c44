import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("06_laplacians")


def test_cotangent_weights_see_bending_alone(numbers):
    assert numbers["flat_cotangent"] < 1e-12 < 0.05 < numbers["flat_uniform"]


def test_the_spectrum_is_that_of_the_sphere_with_cotangent_weights_only(numbers):
    assert numbers["spectrum_cotangent"] < 0.03
    assert numbers["spectrum_uniform"] > 2 * numbers["spectrum_cotangent"]


def test_more_tones_are_more_of_the_face(numbers):
    assert numbers["low_pass_120"] < 2.5 < 20 < numbers["low_pass_4"]


def test_turned_coordinates_and_arap_bend_without_shear(numbers):
    assert max(numbers["strain_turned"], numbers["strain_arap"]) < 0.2 < 0.5 < numbers["strain_plain"]
    assert abs(numbers["volume_lost_turned"]) < 0.05 < 0.15 < numbers["volume_lost_plain"]


def test_single_points_make_a_needle_a_tent_and_a_hill(numbers):
    assert numbers["angle_membrane"] < 60 < numbers["angle_arap"] < 130 < numbers["angle_laplacian"]


def test_the_face_goes_smoothly_through_its_landmarks(numbers):
    assert numbers["aligned_miss"] < 1e-3 * numbers["fitted_miss"]
    assert numbers["kink_laplacian"] < 0.3 * numbers["kink_membrane"]


def test_the_root_stays_and_the_exercises_come_out(numbers):
    assert numbers["root_moved"] == 0
    assert numbers["noise_left"] < 0.6
    assert numbers["miss_ratio"] == pytest.approx(10, rel=0.1)
