"""The loss whose pose follows the shape: the same loss, its gradient, and what is decoupled."""

import numpy as np
import pytest

from toongeo.metrics import check_gradient
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.losses.decoupled_pose import decoupled_pose
from toongeo.pipeline.fit.losses.nlopt_minimize import nlopt_minimize
from toongeo.pipeline.fit.problem.starting_problem import starting_problem
from toongeo.render import ScaledOrthographicCamera


@pytest.fixture(scope="module", params=["orthographic", "perspective"])
def problem(request, model, annotated, random_face):
    points = annotated(model, ScaledOrthographicCamera.look(yaw=25, pitch=-8, roll=5), *random_face(3))
    return starting_problem(model, points, FitOptions(camera=request.param, robust=None))


@pytest.fixture(scope="module")
def loss(problem):
    placed = problem.first_state(problem.search.start)
    return problem.loss(placed.vertices, placed.prior_weight)


@pytest.fixture(scope="module")
def start(problem):
    rng = np.random.default_rng(4)
    x = problem.search.start.copy()
    x[problem.unknowns.shape] += 0.2 * rng.standard_normal(problem.unknowns.n_coefficients)
    x[problem.unknowns.rotation] += [0.1, -0.2, 0.05]
    return x


def test_it_is_the_loss_at_another_pose(problem, loss, start):
    decoupled = decoupled_pose(loss, start)
    np.testing.assert_array_equal(decoupled.x(start), start)
    y = start + 0.1 * np.random.default_rng(5).standard_normal(len(start))
    kept = y.copy()
    assert decoupled(y)[0] == loss(decoupled.x(y))[0]
    np.testing.assert_array_equal(y, kept)
    np.testing.assert_array_equal(decoupled.x(y)[problem.unknowns.shape], y[problem.unknowns.shape])
    if problem.unknowns.perspective:
        assert decoupled.x(y)[-1] == y[-1]


def test_taylor_slope(problem, loss, start):
    direction = np.random.default_rng(6).standard_normal(len(start))
    if problem.unknowns.perspective:
        direction[-1] *= 1e-4  # an inverse distance, 1/mm
    assert check_gradient(decoupled_pose(loss, start), start, direction / np.linalg.norm(direction)).passed


def test_the_gauss_newton_matrix_has_no_coupling_with_the_pose_left(problem, loss, start):
    decoupled, pose = decoupled_pose(loss, start), problem.unknowns.pose
    J = loss.landmark.jacobian(start)
    H = 2 * loss.landmark_weight / loss.landmark.count * np.einsum("kin,kij,kjm->nm", J, loss.landmark.weights, J)
    H += np.diag(loss.prior_weight * loss.prior.curvature(start))
    T = np.eye(len(start))
    T[pose] = decoupled.mixing
    scale = 1 / np.sqrt(decoupled.curvature)
    left = scale[:, None] * (T.T @ H @ T) * scale
    np.testing.assert_allclose(left.diagonal(), 1, atol=1e-6)
    np.testing.assert_allclose(left[pose], np.eye(len(start))[pose], atol=1e-6)
    before = H / np.sqrt(np.outer(H.diagonal(), H.diagonal()))
    assert np.linalg.cond(left) < 0.5 * np.linalg.cond(before)


def test_the_minimum_is_the_same_and_found_in_fewer_steps(problem, loss):
    options, start = {"bounds": problem.search.bounds, "tolerance": 1e-13}, problem.search.start
    plain = nlopt_minimize(loss, start, scale=1 / np.sqrt(loss.curvature(start)), **options)
    decoupled = decoupled_pose(loss, start)
    quick = nlopt_minimize(decoupled, start, scale=1 / np.sqrt(decoupled.curvature), **options)
    assert quick.value == pytest.approx(plain.value, rel=1e-6)
    assert quick.evaluations < 0.8 * plain.evaluations
    found = (m[problem.unknowns.shape] for m in (decoupled.x(quick.x), plain.x))
    np.testing.assert_allclose(*found, atol=0.02)
