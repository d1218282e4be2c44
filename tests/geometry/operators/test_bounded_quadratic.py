"""The conditions of Karush, Kuhn and Tucker hold, which for a convex function is the proof."""

import numpy as np
import pytest

from toongeo.geometry.operators.bounded_quadratic import bounded_quadratic


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


def test_what_goes_in_circles_is_left_to_descents():
    """Murty's matrix, on which changing all bounds at once is known to cycle, has a minimum all the same."""
    H = np.array([[4.0, 5.0, -5.0], [5.0, 9.0, -5.0], [-5.0, -5.0, 7.0]])
    for g in np.random.default_rng(0).standard_normal((50, 3)):
        x = bounded_quadratic(H, g, np.zeros(3), np.full(3, np.inf), np.zeros(3))
        slope = H @ x - g
        assert (x >= 0).all() and (slope >= -1e-9).all() and abs(slope @ x) < 1e-9


def test_a_matrix_that_is_not_positive_definite_is_refused():
    with pytest.raises(np.linalg.LinAlgError, match="H: expected a positive definite matrix"):
        bounded_quadratic(np.diag([1.0, -1.0]), np.ones(2), np.full(2, -np.inf), np.full(2, np.inf), np.zeros(2))
