"""Regressors: where a fit starts or its answer, any part missing; and the one that comes along."""

import numpy as np
import pytest

from toongeo.io import read_landmarks
from toongeo.model import data_path
from toongeo.pipeline import PriorOptions, SolverOptions
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.ridge_regressor import train_ridge_regressor
from toongeo.protocols import Coefficients
from toongeo.render import ScaledOrthographicCamera


@pytest.fixture(scope="module")
def points():
    return read_landmarks(data_path("examples/portraits/astronaut.pts"))


@pytest.fixture(scope="module")
def ridge(model):
    return train_ridge_regressor(model, np.random.default_rng(0), 600)


def error_mm(model, V, truth):
    face = model.region("face")
    shift = (V - truth)[face] - (V - truth)[face].mean(axis=0)
    return np.linalg.norm(shift, axis=1).mean()


# --- how a regressor's answer is used ---


def test_the_answer_itself(artist, annotated, random_face):
    identity, expression = random_face(3)
    identity = identity[: len(artist.identity)]
    camera = ScaledOrthographicCamera.look(yaw=25, pitch=-5, roll=7)
    points = annotated(artist, camera, identity, expression)
    answer = Coefficients(identity=identity, expression=expression, albedo=np.ones(9), light=np.ones((3, 9)))
    held = FitOptions(refine=False, prior=PriorOptions(pitch_deviation=1e6))
    fit = fit_3dmm(None, points, model=artist, regressor=lambda img, landmarks: answer, options=held)
    np.testing.assert_array_equal(fit.identity, identity)
    np.testing.assert_array_equal(fit.expression, expression)
    assert fit.albedo is not None and fit.light is not None
    np.testing.assert_array_equal(fit.albedo, answer.albedo)
    np.testing.assert_array_equal(fit.light, answer.light)
    np.testing.assert_allclose(fit.camera.rotation, camera.rotation, atol=2e-3)  # the pose is found
    assert fit.report.rms_percent < 0.1


def test_the_answer_with_its_pose(points):
    camera = ScaledOrthographicCamera.look(yaw=5, size=500)
    fit = fit_3dmm(None, points, regressor=lambda *_: Coefficients(pose=camera), refine=False)
    assert fit.camera is camera
    np.testing.assert_array_equal(fit.identity, fit.model.prior.mean)  # what is not told is likely
    assert not fit.expression.any()


def test_where_the_fit_starts_does_not_change_where_it_ends(model, points, ridge):
    expected = fit_3dmm(None, points, solver=SolverOptions(tolerance=1e-11, max_passes=8))
    for regressor in (
        ridge,
        lambda *_: Coefficients(pose=ScaledOrthographicCamera.look(yaw=12, size=480)),
        lambda *_: Coefficients(identity=np.full(81, 0.3)),
        lambda *_: Coefficients(),
    ):
        found = fit_3dmm(None, points, regressor=regressor, solver=SolverOptions(tolerance=1e-11, max_passes=8))
        assert error_mm(model, found.vertices, expected.vertices) < 0.2


def test_a_regressor_sees_the_picture_and_cannot_change_the_landmarks(points):
    picture = np.zeros((600, 600, 3), np.uint8)

    def meddling(img, landmarks):
        assert img is picture
        landmarks[:] = 0
        return Coefficients()

    np.testing.assert_array_equal(
        fit_3dmm(picture, points, regressor=meddling).vertices, fit_3dmm(picture, points).vertices
    )


def test_coefficients_are_read_only_copies():
    given = np.zeros(3)
    coefficients = Coefficients(identity=given)
    given[0] = 1
    assert coefficients.identity is not None and coefficients.identity[0] == 0
    with pytest.raises(ValueError, match="read-only"):
        coefficients.identity[0] = 2


def test_bad_regressors(points):
    with pytest.raises(ValueError, match=r"regressor: expected identity of shape \(81,\), got \(79,\)"):
        fit_3dmm(None, points, regressor=lambda *_: Coefficients(identity=np.zeros(79)))
    with pytest.raises(ValueError, match="regressor: expected one that returns Coefficients, got ndarray"):
        fit_3dmm(None, points, regressor=lambda *_: np.zeros(81))
    with pytest.raises(ValueError, match="expression: expected finite numbers or None"):
        Coefficients(expression=np.array([np.nan]))
    with pytest.raises(ValueError, match="refine: expected a regressor whose answer is not to be refined"):
        fit_3dmm(None, points, refine=False)
    with pytest.raises(ValueError, match="refine: expected one of True, False, got 'no'"):
        fit_3dmm(None, points, regressor=lambda *_: Coefficients(), refine="no")


# --- the ridge regressor ---


def test_it_knows_faces_it_has_not_seen(model, annotated, random_face, ridge):
    guessed, mean = [], []
    for seed in range(100, 112):
        identity, expression = random_face(seed)
        camera = ScaledOrthographicCamera.look(yaw=5 * (seed - 106))
        answer = ridge(None, annotated(model, camera, identity, expression))
        truth = model.vertices(identity, expression)
        guessed.append(error_mm(model, model.vertices(answer.identity, answer.expression), truth))
        mean.append(error_mm(model, model.mean, truth))
    assert np.mean(guessed) < 0.85 * np.mean(mean)


def test_size_place_and_tilt_change_nothing(points, ridge):
    turned = ScaledOrthographicCamera.look(roll=-35).rotation[:2, :2]
    first, second = ridge(None, points), ridge(None, 3.7 * points @ turned.T + [812, -95])
    np.testing.assert_allclose(first.identity, second.identity, atol=1e-10)
    np.testing.assert_allclose(first.expression, second.expression, atol=1e-10)


def test_missing_points_and_named_expressions(model, points, ridge):
    holed = points.copy()
    holed[::3] = np.nan
    answer = ridge(None, holed)
    named = answer.expression[: model.n_named]
    assert 0 <= named.min() <= named.max() <= 1
    assert answer.expression[model.expression_index("mouthClose")] == 0


def test_a_missing_point_counts_as_one_of_the_mean_face(model, ridge):
    whole = ScaledOrthographicCamera.look(yaw=15, roll=4).project(model.mean[model.landmarks])
    holed = whole.copy()
    holed[::3] = np.nan
    np.testing.assert_allclose(ridge(None, holed).identity, ridge(None, whole).identity, atol=1e-9)
    np.testing.assert_allclose(ridge(None, holed).expression, ridge(None, whole).expression, atol=1e-9)


def test_training_is_repeatable(model):
    first, second = (train_ridge_regressor(model, np.random.default_rng(4), 60) for _ in range(2))
    np.testing.assert_array_equal(first.weights, second.weights)
    with pytest.raises(ValueError, match="read-only"):
        first.weights[0] = 0


def test_bad_training(model, rng, ridge):
    with pytest.raises(ValueError, match="n: expected at least 2 faces, got 1"):
        train_ridge_regressor(model, rng, 1)
    with pytest.raises(ValueError, match=r"ridge: expected a finite number > 0, got 0\.0"):
        train_ridge_regressor(model, rng, 5, ridge=0.0)
    with pytest.raises(ValueError, match="landmarks: expected at least 6 points"):
        ridge(None, np.full((68, 2), np.nan))
