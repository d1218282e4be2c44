import pytest

pytestmark = pytest.mark.slow


def test_what_the_lesson_says_holds(numbers_of):
    numbers = numbers_of("16_drive_speak_export")
    assert numbers["sum_difference_mm"] < 1e-3
    assert numbers["csv_difference"] < 1e-7
    assert numbers["weights_error_library"] < numbers["weights_error_ours"] < 0.06
    assert numbers["speech_difference"] < 1e-12
    assert 0.05 < numbers["lips_seal"] < 1
    assert numbers["targets"] == 54
    assert numbers["glb_is_whole"] == 1
    assert numbers["glb_difference_mm"] < 1e-3
    assert numbers["vrm_expressions"] == 18
    assert numbers["page_from_elsewhere"] == 0
    assert numbers["corner_grows"] == pytest.approx(4)
    assert 0.9 < numbers["s_over_bound"] <= 1
    assert numbers["speed_spoken"] < 0.3 * numbers["speed_stepped"]
    assert 2 * numbers["astray_bounded"] < numbers["astray_free"] < 0.6 * numbers["astray_wild"]
    assert numbers["quantized_off_mm"] < 0.1
    assert numbers["quantized_size"] < 0.6
