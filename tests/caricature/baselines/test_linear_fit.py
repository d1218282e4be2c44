import numpy as np
import pytest

from toongeo.caricature.baselines.bilinear_model import BilinearModel, bilinear_fit
from toongeo.caricature.baselines.caricatured_modes import caricatured_modes
from toongeo.caricature.baselines.linear_fit import equations, linear_fit, ridge_solution
from toongeo.render import ScaledOrthographicCamera


@pytest.fixture(scope="module")
def modes(model):
    return np.concatenate([model.identity, model.expression])


@pytest.fixture(scope="module")
def bilinear(model):
    return BilinearModel.from_model(model, np.random.default_rng(0), identities=60)


def rms_px(fit, landmarks):
    left = fit.project(fit.vertices[fit.landmark_vertices]) - landmarks
    return np.sqrt((left**2).sum(1).mean())


def test_regularization_keeps_the_face_near_the_mean(model, modes, cartoon):
    landmarks = cartoon("bad_guy")[1]
    fits = [linear_fit(landmarks, model, model.mean, modes, weight) for weight in (0.0, 10.0, 3000.0)]
    errors = [rms_px(fit, landmarks) for fit in fits]
    away = [np.abs(fit.vertices - model.mean).mean() for fit in fits]
    assert errors[0] < 1.0 < errors[1] < errors[2]
    assert away[0] > away[1] > away[2]


def test_missing_landmarks_are_left_out(model, modes, cartoon):
    """What is left is met as if it were all there is: the normal equations of the rest hold, and only they."""
    landmarks, missing = cartoon("bad_guy")[1].copy(), [8, 30, 41]
    whole = linear_fit(landmarks, model, model.mean, modes, 3000.0)
    landmarks[missing] = np.nan
    fit = linear_fit(landmarks, model, model.mean, modes, 3000.0)
    seen = np.isfinite(landmarks[:, 0])
    eyes = np.linalg.norm(landmarks[36] - landmarks[45])
    moved = np.linalg.norm(fit.project(fit.vertices) - whole.project(whole.vertices), axis=1)[fit.landmark_vertices]
    assert 0 < moved.max() < 0.1 * eyes
    J, wanted = equations(model.mean, modes, fit.landmark_vertices[seen], landmarks[seen], fit.camera)
    alpha = ridge_solution(J, wanted, 3000.0)
    expected = model.mean + np.tensordot(alpha, modes.astype(float), 1)
    np.testing.assert_allclose(fit.vertices, expected, atol=0.05)  # at the fixed point of pose and coefficients


def test_singular_vectors_are_those_of_the_data_tensor(model, bilinear):
    """The Gram matrix of the unfolded tensor, summed over the expressions, is diagonal in them."""
    A, B = (x.reshape(len(x), -1).astype(float) for x in (bilinear.identities, bilinear.expressions))
    rows = model.mean.ravel() + A
    gram = sum((rows + b) @ (rows + b).T for b in B)
    turned = bilinear.left.T @ gram @ bilinear.left
    values = np.linalg.eigvalsh(gram)[::-1][: len(turned)]
    np.testing.assert_allclose(np.diag(turned), values, rtol=1e-6, atol=1e-9 * values[0])
    np.testing.assert_allclose(turned - np.diag(np.diag(turned)), 0, atol=1e-9 * values[0])


def test_the_core_times_both_vectors_is_the_face(model, bilinear):
    at = model.landmarks
    T = model.mean[at] + bilinear.identities[:, None, at] + bilinear.expressions[None][:, :, at].astype(float)
    u_id, u_exp = bilinear.left[5], bilinear.right[7]
    expected = np.einsum("i,e,iekc->kc", bilinear.left @ u_id, bilinear.right @ u_exp, T)
    np.testing.assert_allclose(bilinear.vertices(u_id, u_exp, at), expected, atol=1e-3)


def test_a_bilinear_face_is_nearer_to_its_landmarks_than_the_mean(model, bilinear, cartoon):
    landmarks = cartoon("bad_guy")[1]
    fit = bilinear_fit(landmarks, model, bilinear)
    mean = linear_fit(landmarks, model, model.mean, model.identity, 1e12)
    assert rms_px(fit, landmarks) < rms_px(mean, landmarks)


def test_a_face_of_the_model_is_met(model, modes, rng):
    camera = ScaledOrthographicCamera.look(size=500)
    V = model.vertices(0.5 * rng.standard_normal(len(model.identity)))
    landmarks = camera.project(V[model.landmarks])
    fit = linear_fit(landmarks, model, model.mean, modes, 0.0)
    assert rms_px(fit, landmarks) < 0.5


def test_caricatured_modes_are_the_components_of_their_shapes(model):
    mean, modes = caricatured_modes(model, np.random.default_rng(1), identities=3, gammas=(0.0, 0.2), count=9)
    components = modes[: len(modes) - len(model.expression)].astype(float).reshape(-1, mean.size)
    assert len(components) == 5  # six shapes about their mean
    gram = components @ components.T
    np.testing.assert_allclose(gram, np.diag(np.diag(gram)), atol=1e-3 * gram.max())
    drawn = np.random.default_rng(1).standard_normal((3, len(model.principal_modes)))[0]
    first = model.vertices(np.append(drawn, np.zeros(len(model.identity) - len(drawn))))
    left = (first - mean).ravel()
    inside = np.linalg.lstsq(components.T, left, rcond=None)[0] @ components
    assert np.abs(inside - left).max() < 0.05
