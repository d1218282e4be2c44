import pytest

pytestmark = pytest.mark.slow


def test_what_the_lesson_says_holds(numbers_of):
    numbers = numbers_of("14_stylize_a_photo")
    assert numbers["slope_displaced"] < -0.5 < 0 < numbers["slope_flowed"]
    assert numbers["flow_difference_px"] < 0.02
    assert numbers["there_and_back_px"] < 0.05
    assert numbers["least_area_factor"] > 0
    assert numbers["similarity_left"] < 1e-12
    assert numbers["largest_change_of_lightness"] <= 100 / 6 / 2
    assert numbers["grey_with_lines"] < numbers["grey_without_difference"]
    assert numbers["colours_of_drawing"] < 0.8 * numbers["colours_of_photograph"]
    assert numbers["squaring_ratio"] == pytest.approx(4, rel=0.05)
    assert numbers["runge_kutta_error"] < 1e-7
    assert numbers["liouville_error"] < 1e-4
    assert numbers["halves_error"] < 1e-7 < 1e-3 < numbers["mean_is_no_half"]
