"""Losses: values by hand, Taylor slopes of every gradient through every unknown, and the Jacobian."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.metrics import check_gradient
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.pipeline.fit.frame.unknowns import Unknowns
from toongeo.pipeline.fit.losses.landmark_loss import LandmarkLoss
from toongeo.pipeline.fit.losses.pitch_prior import PitchPrior
from toongeo.pipeline.fit.losses.prior_loss import PriorLoss
from toongeo.pipeline.fit.losses.total_loss import TotalLoss
from toongeo.render import ScaledOrthographicCamera

BLOCKS = ["identity", "expression", "rotation", "log_scale", "translation", "everything"]


@pytest.fixture(scope="module")
def unknowns(model):
    return Unknowns(len(model.identity), len(model.expression))


@pytest.fixture(scope="module")
def landmark_loss(model, unknowns):
    rng = np.random.default_rng(5)
    mean, modes = landmark_basis(model).at(model.landmarks)
    half = rng.normal(0, 1, (68, 2, 2))
    return LandmarkLoss(
        unknowns=unknowns,
        points=mean[:, :2] + rng.normal(0, 4, (68, 2)),
        weights=half @ half.transpose(0, 2, 1) / 80**2,
        count=68,
        mean=mean,
        modes=modes,
        rotation0=ScaledOrthographicCamera.look(yaw=20, pitch=-10).rotation,
    )


@pytest.fixture(scope="module")
def x(unknowns):
    rng = np.random.default_rng(6)
    x = 0.5 * rng.standard_normal(unknowns.size)
    x[unknowns.translation] *= 20
    return x


def mean(unknowns):
    m = np.zeros(unknowns.size)
    m[unknowns.identity] = np.linspace(-1, 2, unknowns.n_identity)
    return m


def direction(unknowns, block):
    d = np.zeros(unknowns.size)
    where = slice(None) if block == "everything" else getattr(unknowns, block)
    d[where] = np.random.default_rng(7).standard_normal(d[where].shape)
    return d / np.linalg.norm(d)


@pytest.mark.parametrize("block", BLOCKS)
@pytest.mark.parametrize("term", ["landmark", "prior", "nod", "total"])
def test_taylor_slope(landmark_loss, unknowns, x, block, term):
    prior = PriorLoss(unknowns, 1.3, 4.0, mean(unknowns))
    nod = PitchPrior(unknowns, landmark_loss.rotation0, 12.0)
    total = TotalLoss(landmark_loss, prior, nod, 0.7, 1e-3, 2e-3)
    loss = {"landmark": landmark_loss, "prior": prior, "nod": nod, "total": total}[term]
    d = direction(unknowns, block)
    pose = block in ("rotation", "log_scale", "translation")
    if (term == "prior" and pose) or (term == "nod" and block not in ("rotation", "everything")):
        assert loss(x)[1] @ d == 0
        assert loss(x + d)[0] == loss(x)[0]
    else:
        assert check_gradient(loss, x, d).passed


def test_eq_4_as_printed(landmark_loss, unknowns, x):
    """With ``W_n = w_n I`` the loss is 1/N sum w_n |q_n - s P R p_n - t|^2, written out point by point."""
    w = np.linspace(0, 1, 68)
    loss = LandmarkLoss(
        unknowns,
        landmark_loss.points,
        w[:, None, None] * np.eye(2),
        68,
        landmark_loss.mean,
        landmark_loss.modes,
        landmark_loss.rotation0,
    )
    camera = ScaledOrthographicCamera(
        np.exp(x[unknowns.log_scale]),
        _rotation(x, unknowns) @ loss.rotation0,
        x[unknowns.translation] * [1, -1],
    )
    p = loss.mean + np.tensordot(loss.modes.reshape(68, 3, -1), x[unknowns.shape], 1)
    q = loss.points * [1, -1]
    expected = sum(w[n] * np.sum((q[n] - camera.project(p)[n]) ** 2) for n in range(68)) / 68
    assert loss(x)[0] == pytest.approx(expected, rel=1e-12)


def _rotation(x, unknowns):
    return Rotation.from_rotvec(x[unknowns.rotation]).as_matrix()


def test_eq_6_as_printed(unknowns, x):
    value = PriorLoss(unknowns, 2.0, 5.0, np.zeros(unknowns.size))(x)[0]
    assert value == pytest.approx(2 * np.sum(x[unknowns.identity] ** 2) + 5 * np.sum(x[unknowns.expression] ** 2))
    m = mean(unknowns)
    moved = PriorLoss(unknowns, 2.0, 5.0, m)(x + m)
    assert moved[0] == pytest.approx(value)
    assert PriorLoss(unknowns, 2.0, 5.0, m)(m)[0] == 0


@pytest.mark.parametrize("pitch", [-30.0, 0.0, 6.0, 45.0])
@pytest.mark.parametrize(("yaw", "roll"), [(0, 0), (50, 0), (-20, 35)])
def test_a_nod_costs_its_sine_and_turning_and_tilting_nothing(unknowns, yaw, pitch, roll):
    rotation = ScaledOrthographicCamera.look(yaw=yaw, pitch=pitch, roll=roll).rotation
    value = PitchPrior(unknowns, rotation, 6.0)(np.zeros(unknowns.size))[0]
    assert value == pytest.approx((np.sin(np.radians(pitch)) / np.radians(6.0)) ** 2, abs=1e-12)


def test_jacobian_is_the_derivative_of_the_residuals(landmark_loss, unknowns, x):
    J = landmark_loss.jacobian(x)
    h = 1e-6
    for block in BLOCKS:
        d = direction(unknowns, block)
        difference = (landmark_loss.residuals(x + h * d) - landmark_loss.residuals(x - h * d)) / (2 * h)
        np.testing.assert_allclose(J @ d, difference, atol=2e-7)


def test_gradient_and_curvature_come_from_the_jacobian(landmark_loss, x):
    J, e = landmark_loss.jacobian(x), landmark_loss.residuals(x)
    W = landmark_loss.weights
    gradient = 2 / 68 * np.einsum("kin,kij,kj->n", J, W, e)
    np.testing.assert_allclose(landmark_loss(x)[1], gradient, rtol=1e-9, atol=1e-14)
    curvature = 2 / 68 * np.einsum("kin,kij,kjn->n", J, W, J)
    np.testing.assert_allclose(landmark_loss.curvature(x), curvature, rtol=1e-9)


def test_the_bent_matrix_is_the_second_derivative(landmark_loss, unknowns, x):
    """By central differences of the gradient, where the rotation vector is zero; elsewhere nearly, and symmetric."""
    level = x.copy()
    level[unknowns.rotation] = 0.0
    step = 1e-5
    expected = np.array(
        [
            (landmark_loss(level + step * row)[1] - landmark_loss(level - step * row)[1]) / (2 * step)
            for row in np.eye(unknowns.size)
        ]
    )
    value, slope, matrix = landmark_loss.normal(level, bent=True)
    np.testing.assert_allclose(matrix, (expected + expected.T) / 2, atol=1e-7 * np.abs(expected).max())
    assert value == pytest.approx(landmark_loss(level)[0], rel=1e-12)
    np.testing.assert_allclose(slope, landmark_loss(level)[1], atol=1e-12)
    plain, turned = (landmark_loss.normal(x, bent=bent)[2] for bent in (False, True))
    np.testing.assert_allclose(turned, turned.T, atol=1e-12)
    assert np.abs(turned - plain).max() > 1e-3 * np.abs(plain).max()


def test_the_matrix_of_the_total_loss_is_that_of_its_residuals(landmark_loss, unknowns, x):
    """Landmarks from their Jacobian; the nod is one squared residual."""
    prior = PriorLoss(unknowns, 0.7, 0.4, mean(unknowns))
    nod = PitchPrior(unknowns, landmark_loss.rotation0, 7.0)
    loss = TotalLoss(landmark_loss, prior, nod, landmark_weight=1.2, prior_weight=0.3, pitch_weight=0.5)
    J = landmark_loss.jacobian(x)
    expected = 1.2 * 2 / 68 * np.einsum("kin,kij,kjm->nm", J, landmark_loss.weights, J)
    expected += 0.3 * np.diag(np.repeat([1.4, 0.8, 0.0], [unknowns.n_identity, unknowns.n_expression, 6]))
    value, slope = nod(x)  # L = r^2: its matrix 2 r' r'^T is g g^T / (2 L)
    expected += 0.5 * np.outer(slope, slope) / (2 * value)
    np.testing.assert_allclose(loss.normal(x)[2], expected, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(np.diag(loss.normal(x)[2]), loss.curvature(x), rtol=1e-9)


def test_a_point_without_weight_pulls_nothing(landmark_loss, x):
    weights = np.zeros((68, 2, 2))
    loss = LandmarkLoss(
        landmark_loss.unknowns,
        landmark_loss.points,
        weights,
        68,
        landmark_loss.mean,
        landmark_loss.modes,
        landmark_loss.rotation0,
    )
    value, gradient = loss(x)
    assert value == 0
    assert not gradient.any()
