"""Stretches of a take."""

import numpy as np
import pytest

from toongeo.driving import Take


@pytest.fixture
def take():
    times = np.array([5.0, 5.5, 6.0, 7.0])
    return Take(times, np.arange(4)[:, None] * np.ones(54) / 10, np.arange(12.0).reshape(4, 3))


def test_a_stretch_begins_at_zero_and_has_its_own_frames(take):
    part = take.between(0.5, 1.0)
    np.testing.assert_allclose(part.times, [0, 0.5])
    np.testing.assert_array_equal(part.weights, take.weights[1:3])
    np.testing.assert_array_equal(part.head, take.head[1:3])
    whole = take.between()
    np.testing.assert_array_equal(whole.weights, take.weights)
    np.testing.assert_allclose(whole.times, [0, 0.5, 1, 2])


def test_two_stretches_are_the_whole(take):
    first, second = take.between(end=0.5), take.between(start=0.6)
    np.testing.assert_array_equal(np.vstack([first.weights, second.weights]), take.weights)


def test_nothing_between_is_refused(take):
    with pytest.raises(ValueError, match=r"start, end: expected a frame between 3 and 9 s, got none \(the take"):
        take.between(3, 9)
