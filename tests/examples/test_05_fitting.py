import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("05_fitting")


def test_the_right_gradient_has_slope_two_and_the_wrong_one(numbers):
    assert numbers["slope_right"] > 1.9
    assert numbers["slope_wrong"] == pytest.approx(1, abs=0.05)
    assert 1e-7 <= numbers["best_step"] <= 1e-4


def test_scaled_unknowns_arrive_sooner_and_steepest_descent_never(numbers):
    assert numbers["evaluations_scaled"] < 0.4 * numbers["evaluations_plain"]
    assert numbers["steepest_descent_over_best"] > 1.5


def test_the_prior_has_a_best_weight_near_the_expected_noise(numbers):
    assert numbers["error_used"] < 0.5 * numbers["start_error"]
    assert numbers["held_out_best"] < min(numbers["held_out_weak"], numbers["held_out_strong"])
    assert 1e-7 <= numbers["best_prior_weight"] <= 1e-5
    assert 1e-6 <= numbers["best_prior_weight_3d"] <= 1e-4
    assert numbers["error_3d_best"] < numbers["error_3d_mean_face"] < numbers["error_3d_weak"]


def test_the_kernel_outvotes_outliers(numbers):
    clean, squares, robust = (numbers[f"outliers_{how}"] for how in ("clean", "squares", "robust"))
    assert clean < robust < 0.5 * squares
    assert robust < numbers["huber"] < squares
    assert numbers["library_moved_robust"] < 0.5 * numbers["library_moved_squares"]


def test_it_comes_near_to_the_library(numbers):
    assert numbers["library_difference"] < 2.5
    assert 100 * numbers["error_used"] == pytest.approx(numbers["library_percent"], abs=0.5)


def test_one_valley_and_bounds_that_matter(numbers):
    assert numbers["starts_that_arrive"] == 1
    assert numbers["starts_with_other_angles"] > 0
    assert numbers["most_negative"] < -0.2
