"""Minima known in closed form, and those of nlopt; what happens where a step is too long, or leads nowhere."""

from dataclasses import dataclass

import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo import read_landmarks
from toongeo.model import data_path
from toongeo.pipeline import SolverOptions
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.losses.gauss_newton import gauss_newton
from toongeo.pipeline.fit.losses.minimized import minimized
from toongeo.pipeline.fit.problem.starting_problem import starting_problem

FREE = (np.full(2, -np.inf), np.full(2, np.inf))


@dataclass
class Valley:
    """Rosenbrock's ``(1 - x)^2 + 100 (y - x^2)^2``: a step to the minimum of its model climbs the wall."""

    calls: int = 0

    def __call__(self, z):
        r = np.array([1 - z[0], 10 * (z[1] - z[0] ** 2)])
        return float(r @ r), 2 * self.jacobian(z).T @ r

    def jacobian(self, z):
        return np.array([[-1.0, 0.0], [-20 * z[0], 10.0]])

    def normal(self, z, *, bent=False):
        self.calls += 1
        value, slope = self(z)
        matrix = 2 * self.jacobian(z).T @ self.jacobian(z)
        if bent:
            matrix[0, 0] += -40 * 10 * (z[1] - z[0] ** 2)
        return value, slope, matrix


class Uphill(Valley):
    """Its gradient points the wrong way: no step lowers it."""

    def __call__(self, z):
        value, slope = super().__call__(z)
        return value, -slope


def test_a_curved_valley_is_followed_to_its_end():
    found = gauss_newton(Valley(), np.array([-1.2, 1.0]), bounds=FREE, tolerance=1e-12)
    np.testing.assert_allclose(found.x, [1.0, 1.0], atol=1e-5)
    assert found.status == "FTOL_REACHED" and found.evaluations < 40


def test_a_bound_in_the_way_holds_to_the_bit():
    bounds = (np.array([-2.0, -2.0]), np.array([0.5, 2.0]))
    found = gauss_newton(Valley(), np.array([-1.2, 9.0]), bounds=bounds, tolerance=1e-12)
    assert found.x[0] == 0.5
    assert found.x[1] == pytest.approx(0.25, abs=1e-6)
    assert found.value == pytest.approx(0.25)


def test_equal_bounds_leave_nothing_to_do():
    held = np.array([0.3, 0.4])
    found = gauss_newton(Valley(), np.zeros(2), bounds=(held, held))
    np.testing.assert_array_equal(found.x, held)
    assert (found.status, found.evaluations) == ("FTOL_REACHED", 1)


@pytest.mark.parametrize(("limit", "status"), [({"max_evaluations": 3}, "MAXEVAL"), ({"max_seconds": 1e-9}, "MAXTIME")])
def test_a_limit_is_kept_and_said(limit, status):
    start = np.array([-1.2, 1.0])
    found = gauss_newton(Valley(), start, bounds=FREE, **limit)
    assert found.status == f"{status}_REACHED"
    assert found.evaluations <= limit.get("max_evaluations", 6)  # one step, and its halvings
    assert found.value == Valley()(found.x)[0] <= Valley()(start)[0]


def test_where_nothing_falls_the_answer_is_the_start():
    start = np.array([-1.2, 1.0])
    found = gauss_newton(Uphill(), start, bounds=FREE)
    np.testing.assert_array_equal(found.x, start)
    assert found.status == "ROUNDOFF_LIMITED"


@pytest.mark.parametrize("name", CARTOONS)
def test_the_minimum_of_a_drawing_is_that_of_nlopt(model, name):
    """Drawings miss their points by much; there the bent matrix counts, and is not always positive definite."""
    points = read_landmarks(data_path(f"examples/portraits/{name}.pts"))
    problem = starting_problem(model, points, FitOptions())
    state = problem.first_state(problem.search.start)
    loss = problem.loss(state.vertices, state.prior_weight, state.robust_weight)
    bounds, solver = problem.search.bounds, SolverOptions(tolerance=1e-13, max_evaluations=20000)
    ours, other = (
        minimized(loss, problem.search.start, bounds, algorithm, solver) for algorithm in ("gauss-newton", "LD_LBFGS")
    )
    assert ours.value <= other.value * (1 + 1e-9)
    assert ours.evaluations < 40 < other.evaluations
    assert (bounds[0] <= ours.x).all() and (ours.x <= bounds[1]).all()
