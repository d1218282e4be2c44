import numpy as np
import pytest

from toongeo.pipeline.align.symmetric_field import MIRROR, FieldPrior, field_covariance, most_likely_field

ALL_SEEN = np.eye(3)  # not what a camera does, but the formulas hold


def points(rng, k):
    return rng.normal(size=(k, 3)) * [0.6, 0.8, 0.5]


@pytest.mark.parametrize("growth", [0.0, 0.3, 0.9])
@pytest.mark.parametrize("asymmetry", [0.0, 0.07, 1.0])
def test_the_covariance_is_one(rng, growth, asymmetry):
    X = points(rng, 20)
    prior = FieldPrior(growth=growth, asymmetry=asymmetry)
    K = field_covariance(X, X, prior).swapaxes(1, 2).reshape(60, 60)
    np.testing.assert_allclose(K, K.T, atol=1e-12)
    assert np.linalg.eigvalsh(K).min() > -1e-9


@pytest.mark.parametrize("growth", [0.0, 0.3])
def test_the_field_is_the_posterior_mean(rng, growth):
    """Without 3x3 blocks and by them."""
    X, Y, J = points(rng, 30), points(rng, 12), rng.normal(size=(12, 2, 3))
    observed = rng.normal(size=(12, 2))
    prior = FieldPrior(growth=growth)
    A = np.zeros((24, 36))
    for i in range(12):
        A[2 * i : 2 * i + 2, 3 * i : 3 * i + 3] = J[i]
    inner = field_covariance(Y, Y, prior).swapaxes(1, 2).reshape(36, 36)
    cross = field_covariance(X, Y, prior).swapaxes(1, 2).reshape(90, 36)
    expected = cross @ A.T @ np.linalg.solve(A @ inner @ A.T + prior.noise * np.eye(24), observed.ravel())
    found = most_likely_field(X, Y, J, observed, prior)
    np.testing.assert_allclose(found, expected.reshape(30, 3), atol=1e-9)


def test_what_is_seen_of_one_half_happens_to_the_other(rng):
    """Without asymmetry the field is its own mirror image."""
    X, Y = points(rng, 30), points(rng, 10)
    J = np.tile(np.eye(3)[:2], (10, 1, 1))
    prior = FieldPrior(asymmetry=0.0)
    observed = rng.normal(size=(10, 2))
    here, there = (most_likely_field(at, Y, J, observed, prior) for at in (X, X * MIRROR))
    np.testing.assert_allclose(there, here * MIRROR, atol=1e-12)


def test_a_mirrored_question_has_the_mirrored_answer(rng):
    X, Y = points(rng, 30), points(rng, 10)
    J, observed = rng.normal(size=(10, 2, 3)), rng.normal(size=(10, 2))
    here = most_likely_field(X, Y, J, observed, FieldPrior())
    there = most_likely_field(X * MIRROR, Y * MIRROR, J * MIRROR, observed, FieldPrior())
    np.testing.assert_allclose(there, here * MIRROR, atol=1e-12)


def test_without_noise_what_was_seen_is_met(rng):
    Y = points(rng, 10)
    J, observed = rng.normal(size=(10, 2, 3)), rng.normal(size=(10, 2))
    field = most_likely_field(Y, Y, J, observed, FieldPrior(noise=1e-12))
    np.testing.assert_allclose(np.einsum("kac,kc->ka", J, field), observed, atol=1e-6)


def test_curl_free_at_growth_one(rng):
    """The rows of the covariance are gradients: mixed derivatives agree."""
    prior = FieldPrior(growth=1.0, linear=0.0, asymmetry=1.0)
    x, y, h = points(rng, 1)[0], points(rng, 1), 1e-5

    def derivative(axis):
        step = np.eye(3)[axis] * h
        return (field_covariance(x + [step], y, prior) - field_covariance(x - [step], y, prior))[0, 0] / (2 * h)

    gradient = np.array([derivative(axis) for axis in range(3)])  # [axis, component, .]
    np.testing.assert_allclose(gradient, gradient.swapaxes(0, 1), atol=1e-8)


def test_what_grows_in_the_picture_grows_in_depth():
    """A frontal view of a patch that swells: depth swells with it if the prior says so."""
    side = np.linspace(-0.2, 0.2, 5)
    Y = np.stack(np.meshgrid(side, side, [0.0]), -1).reshape(-1, 3)
    J = np.tile(np.eye(3)[:2], (len(Y), 1, 1))
    probes = np.array([[0, 0, -0.05], [0, 0, 0.05]])
    stretch = {}
    for growth in (0.0, 0.3, 0.6):
        field = most_likely_field(probes, Y, J, 0.3 * Y[:, :2], FieldPrior(growth=growth))
        stretch[growth] = (field[1] - field[0])[2] / 0.1
    assert abs(stretch[0.0]) < 1e-9 and 0.02 < stretch[0.3] < stretch[0.6] < 0.3
