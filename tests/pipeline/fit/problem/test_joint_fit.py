"""Several pictures of one person: one identity, and a better one than each picture gives alone."""

import numpy as np
import pytest

from toongeo.metrics import check_gradient
from toongeo.pipeline import SolverOptions
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_3dmm_together import fit_3dmm_together
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.losses.joint_loss import JointLoss
from toongeo.pipeline.fit.problem.starting_problem import starting_problem
from toongeo.render import ScaledOrthographicCamera

CAMERAS = [ScaledOrthographicCamera.look(yaw=yaw, pitch=4, size=500 + 5 * yaw) for yaw in (-30, 0, 25)]


@pytest.fixture(scope="module")
def person(model, annotated, random_face):
    """Function ``seed -> (identity, landmarks in three pictures)``: another expression in each, and 1 px of noise."""

    def draw(seed):
        identity = 1.4 * random_face(seed)[0]
        noise = np.random.default_rng(seed).normal(0, 1, (3, 68, 2))
        expressions = [random_face(seed + 1000 * k)[1] for k in range(3)]
        pictures = [annotated(model, c, identity, e) for c, e in zip(CAMERAS, expressions, strict=True)]
        return identity, list(np.array(pictures) + noise)

    return draw


@pytest.mark.parametrize("block", ["identity", "expression", "rotation", "everything"])
def test_taylor_slope(model, person, block):
    problems = [starting_problem(model, points, FitOptions()) for points in person(0)[1]]
    losses = [p.loss(model.landmarks, 1e-4 * (k + 1)) for k, p in enumerate(problems)]
    loss, u = JointLoss(losses), problems[0].unknowns
    rng = np.random.default_rng(3)
    x, d = (0.2 * rng.standard_normal(3 * u.size - 2 * u.n_identity) for _ in range(2))
    if block != "everything":
        kept = np.zeros(u.size)
        kept[getattr(u, block)] = 1
        d = d * (loss.joined([kept] * 3) > 0)
    assert check_gradient(loss, x, d / np.linalg.norm(d)).passed


def test_the_prior_of_the_identity_counts_once(model, person):
    points = person(0)[1][0]
    problem = starting_problem(model, points, FitOptions())
    single = problem.loss(model.landmarks, 1e-4)
    x = 0.3 * np.random.default_rng(1).standard_normal(problem.unknowns.size)
    person_only = np.where(np.arange(len(x)) < problem.unknowns.n_identity, x, 0)
    double = JointLoss([single, single])
    once = 2 * single(x)[0] - 1e-4 * single.prior(person_only)[0]
    assert double(double.joined([x, x]))[0] == pytest.approx(once, rel=1e-12)
    assert JointLoss([single])(x)[0] == pytest.approx(single(x)[0], rel=1e-12)


def test_the_matrix_of_the_sum_is_its_second_derivative(model, person):
    problems = [starting_problem(model, points, FitOptions()) for points in person(0)[1]]
    loss = JointLoss([p.loss(model.landmarks, 1e-4 * (k + 1)) for k, p in enumerate(problems)])
    x = loss.joined([p.search.start for p in problems])
    way = np.random.default_rng(4).standard_normal(len(x)) / np.sqrt(loss.curvature(x))
    step = 1e-4
    expected = (loss(x + step * way)[1] - loss(x - step * way)[1]) / (2 * step)
    _, slope, matrix = loss.normal(x, bent=True)
    # The prior on the pitch is left at Gauss and Newton's, of its small weight.
    np.testing.assert_allclose(matrix @ way, expected, atol=5e-3 * np.abs(expected).max())
    np.testing.assert_array_equal(slope, loss(x)[1])


def test_one_identity_and_three_poses(person):
    pictures = person(1)[1]
    fits = fit_3dmm_together([None] * 3, pictures)
    assert len(fits) == 3
    for fit, camera in zip(fits, CAMERAS, strict=True):
        np.testing.assert_array_equal(fit.identity, fits[0].identity)
        assert fit.camera.yaw == pytest.approx(camera.yaw, abs=5)
        assert fit.report.rms_percent < 6 and 1 <= fit.report.passes <= 10
    assert np.abs(fits[0].expression - fits[1].expression).max() > 0.01


def test_a_list_of_one_is_the_fit_of_one(person):
    points = person(2)[1][0]
    (listed,) = fit_3dmm_together([None], [points])
    alone = fit_3dmm(None, points)
    np.testing.assert_allclose(listed.vertices, alone.vertices, atol=1e-9)
    assert (listed.report.passes, listed.report.evaluations) == (alone.report.passes, alone.report.evaluations)


def test_three_pictures_know_a_person_better_than_one(model, person):
    face = model.region("face")

    def error_mm(fit, truth):
        difference = (model.vertices(fit.identity) - truth)[face]
        return np.linalg.norm(difference - difference.mean(axis=0), axis=1).mean()

    alone, together = [], []
    for seed in range(10, 18):
        identity, pictures = person(seed)
        truth = model.vertices(identity)
        alone.append(np.mean([error_mm(fit_3dmm(None, points), truth) for points in pictures]))
        together.append(error_mm(fit_3dmm_together([None] * 3, pictures)[0], truth))
    assert np.mean(together) < 0.93 * np.mean(alone)
    assert np.sum(np.less(together, alone)) >= 6


def test_the_order_of_the_pictures_does_not_matter(person):
    pictures = person(3)[1]
    first = fit_3dmm_together([None] * 3, pictures, solver=SolverOptions(tolerance=1e-11))
    second = fit_3dmm_together([None] * 3, pictures[::-1], solver=SolverOptions(tolerance=1e-11))
    np.testing.assert_allclose(second[0].identity, first[2].identity, atol=2e-3)


def test_one_fit_refuses_several_pictures(person):
    with pytest.raises(ValueError, match="img: expected one picture or None, got 2; fit_3dmm_together fits several"):
        fit_3dmm([None] * 2, person(0)[1][:2])


def test_as_many_landmarks_as_pictures(person):
    with pytest.raises(ValueError, match="landmarks: expected one set for each of 2 pictures, got 3"):
        fit_3dmm_together([None] * 2, person(0)[1])
    with pytest.raises(ValueError, match="landmarks: expected one set for each of 0 pictures"):
        fit_3dmm_together([], [])
