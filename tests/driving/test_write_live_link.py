"""Takes written as the phone's app does, and read again."""

import numpy as np
import pytest

from toongeo.driving import Take, read_live_link, write_live_link
from toongeo.model.expression_schemes import EXPRESSIONS

# Columns of the format that move two expressions each: they cannot tell these apart.
PAIRS = [("browInnerUpLeft", "browInnerUpRight"), ("cheekPuffLeft", "cheekPuffRight")]


@pytest.mark.parametrize("fps", [7.0, 15.0, 23.976, 30.0, 60.0, 100.0])
def test_a_take_comes_back(tmp_path, rng, fps):
    count = int(3 * fps)
    weights = rng.random((count, 54))
    for one, other in PAIRS:
        weights[:, EXPRESSIONS.index(one)] = weights[:, EXPRESSIONS.index(other)]
    take = Take(5 + np.arange(count) / fps, weights, rng.standard_normal((count, 3)))
    write_live_link(tmp_path / "take.csv", take)
    again = read_live_link(tmp_path / "take.csv")
    np.testing.assert_allclose(again.times, take.times - 5, atol=2e-5)
    np.testing.assert_allclose(again.weights, weights, atol=1e-7)
    np.testing.assert_allclose(again.head, take.head, atol=1e-7)


def test_halves_that_differ_come_back_as_their_mean(tmp_path):
    weights = np.zeros((2, 54))
    weights[:, EXPRESSIONS.index("browInnerUpLeft")] = 0.6
    write_live_link(tmp_path / "take.csv", Take.of_frames(weights, 30))
    again = read_live_link(tmp_path / "take.csv")
    for name in PAIRS[0]:
        np.testing.assert_allclose(again.weights[:, EXPRESSIONS.index(name)], 0.3)
    assert (again.head == 0).all()


def test_a_long_take_goes_past_minutes_and_midnight(tmp_path):
    times = np.array([0.0, 59.99999, 3661.5, 86399.5, 86400.5])
    write_live_link(tmp_path / "take.csv", Take(times, np.zeros((5, 54))))
    lines = (tmp_path / "take.csv").read_text().splitlines()
    codes = [line.split(",")[0] for line in lines[1:]]
    assert codes == ["00:00:00:00.000", "00:00:59:59.999", "01:01:01:30.000", "23:59:59:30.000", "00:00:00:30.000"]
    np.testing.assert_allclose(read_live_link(tmp_path / "take.csv").times, times, atol=2e-5)


def test_time_that_rounds_up_begins_the_next_second(tmp_path):
    write_live_link(tmp_path / "take.csv", Take(np.array([0.0, 0.9999999]), np.zeros((2, 54))))
    assert "\n00:00:01:00.000," in (tmp_path / "take.csv").read_text().replace("\r", "")


def test_bad_input_is_refused(tmp_path):
    take = Take.of_frames(np.zeros((2, 54)), 30)
    with pytest.raises(ValueError, match="fps: expected a rate > 0, got -1"):
        write_live_link(tmp_path / "take.csv", take, fps=-1)
    with pytest.raises(OSError, match="cannot write"):
        write_live_link(tmp_path / "none" / "take.csv", take)
    assert list(tmp_path.iterdir()) == []
