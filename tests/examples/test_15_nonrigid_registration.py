import pytest

pytestmark = pytest.mark.slow


def test_what_the_lesson_says_holds(numbers_of):
    numbers = numbers_of("15_nonrigid_registration")
    assert numbers["similarity_scale_difference"] < 1e-12
    assert numbers["similarity_rotation_difference"] < 1e-12
    assert max(numbers["truth_ours_mm"], numbers["truth_library_mm"]) < 0.5 * numbers["truth_similarity_mm"]
    assert max(numbers["surface_ours_mm"], numbers["surface_library_mm"]) < 0.1
    assert max(numbers["turned_ours"], numbers["turned_library"]) < 0.1 * numbers["turned_jumped"]
    assert numbers["ours_to_library_mm"] < 1.5
    assert numbers["matched"] > 0.9
    assert numbers["expressions"] == 46
    assert numbers["jaw_motion_error"] < 0.2
    assert numbers["surface_hasty_mm"] < 0.1 < 1 < numbers["truth_hasty_mm"] / numbers["truth_ours_mm"]
    assert numbers["frame_difference_mm"] < 1e-8
    assert numbers["truth_library_mm"] < numbers["truth_seven_points_mm"] < numbers["truth_similarity_mm"]
