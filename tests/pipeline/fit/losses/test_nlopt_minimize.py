"""nlopt's optimizers on problems with known minima, and what they say when they fail."""

import nlopt
import numpy as np
import pytest

from toongeo.pipeline.fit.losses.nlopt_minimize import known_algorithms, nlopt_minimize

LOCAL = [name for name in known_algorithms() if name.startswith("LD_")]
FREE = (np.full(2, -10.0), np.full(2, 10.0))


def quadratic(x):
    return float((x[0] - 3) ** 2 + 100 * (x[1] + 2) ** 2), np.array([2 * (x[0] - 3), 200 * (x[1] + 2)])


def minimize(objective=quadratic, start=(0.0, 0.0), bounds=FREE, scale=(1.0, 0.1), **options):
    return nlopt_minimize(objective, np.array(start), bounds=bounds, scale=np.array(scale), **options)


@pytest.mark.parametrize("algorithm", LOCAL)
def test_every_gradient_method_finds_the_minimum_of_a_quadratic(algorithm):
    found = minimize(algorithm=algorithm, tolerance=1e-14)
    np.testing.assert_allclose(found.x, [3, -2], atol=1e-5)
    assert found.value == pytest.approx(quadratic(found.x)[0])
    assert found.evaluations > 0


@pytest.mark.parametrize("algorithm", LOCAL)
def test_bounds_hold(algorithm):
    found = minimize(algorithm=algorithm, bounds=(np.array([-1.0, -1.0]), np.array([1.0, 1.0])), tolerance=1e-12)
    np.testing.assert_allclose(found.x, [1, -1], atol=1e-6)
    assert (np.abs(found.x) <= 1).all()


def test_equal_bounds_hold_a_variable():
    found = minimize(bounds=(np.array([-10.0, 0.5]), np.array([10.0, 0.5])))
    np.testing.assert_allclose(found.x, [3, 0.5], atol=1e-6)


def test_a_start_outside_is_moved_inside():
    found = minimize(start=(50.0, -50.0))
    np.testing.assert_allclose(found.x, [3, -2], atol=1e-5)


def test_scaling_changes_the_way_and_not_the_goal():
    np.testing.assert_allclose(
        minimize(scale=(1.0, 1.0), tolerance=1e-14).x,
        minimize(scale=(5.0, 0.2), tolerance=1e-14).x,
        atol=1e-6,
    )


def test_the_limit_of_evaluations_is_a_status():
    def valley(x):
        a, b = x[1] - x[0] ** 2, 1 - x[0]
        return float(100 * a**2 + b**2), np.array([-400 * x[0] * a - 2 * b, 200 * a])

    found = minimize(valley, start=(-1.2, 1.0), scale=(1.0, 1.0), max_evaluations=5, tolerance=1e-14)
    assert found.status == "MAXEVAL_REACHED"
    assert found.value < valley(np.array([-1.2, 1.0]))[0]


def test_the_same_call_twice_is_bit_identical():
    for algorithm in ("LD_LBFGS", "GN_CRS2_LM"):
        first, second = (minimize(algorithm=algorithm, max_evaluations=200) for _ in range(2))
        assert first.x.tobytes() == second.x.tobytes()


def test_known_names_are_nlopts():
    assert "LD_LBFGS" in known_algorithms()
    assert all(hasattr(nlopt, name) for name in known_algorithms())


def test_an_unknown_name_lists_the_known_ones():
    with pytest.raises(ValueError, match="algorithm: no algorithm 'LBFGS'; known: .*LD_LBFGS"):
        minimize(algorithm="LBFGS")


def test_contradictory_bounds():
    with pytest.raises(ValueError, match=r"bounds: expected lower <= upper, got 2\.0 > 1\.0 for variable 1"):
        minimize(bounds=(np.array([0.0, 2.0]), np.array([1.0, 1.0])))


def test_a_failure_of_nlopt_says_who_and_why():
    with pytest.raises(RuntimeError, match=r"GN_AGS: nlopt failed \(.+, result -\d\) after \d+ evaluations"):
        nlopt_minimize(
            lambda x: (float(x @ x), 2 * x),
            np.zeros(20),
            bounds=(np.full(20, -1.0), np.full(20, 1.0)),
            scale=np.ones(20),
            algorithm="GN_AGS",
        )


def test_an_objective_without_a_finite_value():
    with pytest.raises(RuntimeError, match="LD_LBFGS: nlopt failed"):
        minimize(lambda x: (float("nan"), np.full(2, np.nan)), max_evaluations=50)


def test_an_error_in_the_objective_comes_through():
    def broken(x):
        raise ZeroDivisionError("from the objective")

    with pytest.raises(ZeroDivisionError, match="from the objective"):
        minimize(broken)


def test_no_further_progress_in_floating_point_is_an_answer(monkeypatch):
    class Stuck(nlopt.opt):
        def optimize(self, x):
            super().optimize(x)
            raise nlopt.RoundoffLimited

    monkeypatch.setattr(nlopt, "opt", Stuck)
    found = minimize()
    assert found.status == "ROUNDOFF_LIMITED"
    np.testing.assert_allclose(found.x, [3, -2], atol=1e-3)
