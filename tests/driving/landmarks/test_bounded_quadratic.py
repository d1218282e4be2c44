"""The conditions of Karush, Kuhn and Tucker hold, which for a convex function is the proof."""

import numpy as np
import pytest

from toongeo.driving.landmarks.bounded_quadratic import bounded_quadratic


@pytest.mark.parametrize("seed", range(20))
def test_the_answer_is_the_minimum(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 40))
    A = rng.standard_normal((n + 3, n)) * 10 ** rng.uniform(-2, 2, n)
    H, g = A.T @ A + 1e-6 * np.eye(n), A.T @ rng.standard_normal(n + 3)
    low, high = np.where(rng.random(n) < 0.3, -np.inf, -rng.random(n)), np.where(rng.random(n) < 0.3, np.inf, 0.5)
    start = np.clip(rng.standard_normal(n), low, high)
    x = bounded_quadratic(H, g, low, high, start)
    slope, scale = H @ x - g, 1e-7 * (1 + np.abs(g).max())
    assert ((low <= x) & (x <= high)).all()
    assert (slope[x > low] < scale).all() and (slope[x < high] > -scale).all()


def test_bounds_that_meet_and_a_start_outside():
    x = bounded_quadratic(
        np.eye(3), np.array([2.0, 2.0, -2.0]), np.zeros(3), np.array([1.0, 0.0, 1.0]), np.full(3, 9.0)
    )
    np.testing.assert_array_equal(x, [1.0, 0.0, 0.0])
