import pytest

pytestmark = pytest.mark.slow


def test_what_the_lesson_says_holds(numbers_of):
    numbers = numbers_of("17_swap_in_a_regressor")
    assert numbers["gradient_at_solution"] < 1e-12
    assert numbers["gradient_is_right"] == 1
    assert max(numbers["lstsq_difference"], numbers["svd_difference"]) < 1e-9
    assert numbers["learned_error_mm"] < 0.75 * numbers["average_error_mm"]
    assert numbers["few_faces_by_heart_mm"] < 1e-3 < numbers["average_error_mm"] < numbers["few_faces_on_others_mm"]
    assert numbers["plain_percent"] < numbers["library_percent"] < numbers["smiling_percent"]
    assert numbers["plain_percent"] < numbers["ours_percent"] < numbers["smiling_percent"]
    assert abs(numbers["ours_refined_percent"] - numbers["plain_percent"]) < 0.02
    assert numbers["refined_ends_apart_mm"] < 0.1
    assert 0 < numbers["kept_directions"] <= 136
    assert numbers["neither_mm"] < min(numbers["no_noise_mm"], numbers["no_turns_mm"])
    assert max(numbers["no_noise_mm"], numbers["no_turns_mm"]) < numbers["noise_and_turns_mm"]
