"""Slopes of right and of wrong gradients."""

import numpy as np
import pytest

from toongeo.metrics.check_gradient import check_gradient

X = np.array([0.4, -1.2, 0.7])


def quartic(x):
    return float((x**4).sum() + x[0] * x[1]), 4 * x**3 + np.array([x[1], x[0], 0.0])


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_a_right_gradient_has_slope_two_at_any_scale_of_the_loss(scale):
    report = check_gradient(lambda x: tuple(scale * part for part in quartic(x)), X)
    np.testing.assert_allclose(report.slopes, 2, atol=0.05)
    assert report.passed and report.remainders.shape == (5, 3)
    assert (np.diff(report.steps) < 0).all()


def test_a_quadratic_has_slope_two_and_a_linear_loss_leaves_nothing():
    quadratic = check_gradient(lambda x: (float(x @ x), 2 * x), X)
    np.testing.assert_allclose(quadratic.slopes, 2, atol=1e-3)
    # The remainder is h^2 |d|^2.
    np.testing.assert_allclose(quadratic.remainders, np.tile(quadratic.steps**2, (5, 1)), rtol=1e-4)
    linear = check_gradient(lambda x: (float(3 * x.sum()), np.full(3, 3.0)), X)
    assert np.isinf(linear.slopes).all() and linear.passed


@pytest.mark.parametrize("wrong", [0, 1, 2])
def test_one_wrong_entry_is_found_along_its_axis(wrong):
    def loss(x):
        value, gradient = quartic(x)
        gradient[wrong] *= 1.02
        return value, gradient

    report = check_gradient(loss, X, np.eye(3))
    assert not report.passed
    assert (report.slopes < 1.3).tolist() == [k == wrong for k in range(3)]
    assert not check_gradient(loss, X).passed  # by chance directions too


def test_a_loss_may_write_to_its_argument():
    def loss(x):
        value, gradient = quartic(x)
        x[:] = np.nan
        return value, gradient

    assert check_gradient(loss, X).passed


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"x": [[1.0]]}, r"x: expected finite numbers \(n,\), got shape \(1, 1\)"),
        ({"x": [np.nan, 1.0, 1.0]}, "x: expected finite"),
        ({"directions": np.ones(2)}, r"directions: expected finite numbers \(n,\) or \(k, n\) with n = 3"),
        ({"directions": np.full(3, np.inf)}, "directions: expected finite"),
        ({"steps": [0.1]}, "steps: expected at least two different positive numbers"),
        ({"steps": [0.1, 0.1]}, "steps: expected at least two different"),
        ({"steps": [0.1, -0.1]}, "steps: expected at least two different"),
        ({"loss": lambda x: (0.0, x[:2])}, r"loss: expected a gradient of shape \(3,\), got \(2,\)"),
        ({"loss": lambda x: (np.nan, x)}, "loss: expected finite value and gradient"),
    ],
)
def test_bad_input_is_named(change, message):
    with pytest.raises(ValueError, match=message):
        check_gradient(**{"loss": quartic, "x": X, **change})
