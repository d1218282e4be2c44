import pytest

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def numbers(numbers_of):
    return numbers_of("03_morphable_models")


def test_few_examples_do_not_describe_new_people(numbers):
    assert numbers["left_over_160"] < 0.05 < 0.5 < numbers["left_over_40"] < 0.6 * numbers["left_over_10"]


def test_nobody_is_near_the_average(numbers):
    assert numbers["nearest_person"] > 5


def test_each_measurement_tells_more_and_the_prior_is_needed(numbers):
    assert numbers["error_inner"] < numbers["error_nose"] < numbers["error_nothing"]
    assert numbers["error_without_prior"] > 10 * numbers["error_inner"]
    assert numbers["length_nose"] < numbers["length_inner"] < numbers["length_truth"]


def test_the_exercises_come_out(numbers):
    assert numbers["middle_gap"] < 1e-4
    assert 0.3 <= numbers["best_sigma"] <= 3
    assert numbers["doubt_after"] < numbers["doubt_before"]
