"""The baselines of Table 2: lower landmark errors by more freedom, the pose kept, no prior."""

import numpy as np
import pytest

from toongeo.io import read_landmarks
from toongeo.metrics import check_gradient
from toongeo.model import data_path
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.pipeline.fit.adjust_coefficients import ADJUSTMENTS, DistanceLoss, adjust_coefficients
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.render import ScaledOrthographicCamera


@pytest.fixture(scope="module", params=["astronaut", "manga_girl"])
def points(request):
    return read_landmarks(data_path(f"examples/portraits/{request.param}.pts"))


@pytest.fixture(scope="module")
def loss(model):
    mean, modes = landmark_basis(model).at(model.landmarks)
    camera = ScaledOrthographicCamera.look(yaw=20, pitch=-10)
    points = camera.project(mean) + np.random.default_rng(5).normal(0, 5, (68, 2))
    return DistanceLoss(camera, points, mean, modes, unit=150.0)


@pytest.mark.parametrize("block", [slice(0, 81), slice(81, 145), slice(0, 145)])
def test_taylor_slope(loss, block):
    rng = np.random.default_rng(6)
    direction = np.zeros(145)
    direction[block] = rng.standard_normal(len(direction[block]))
    assert check_gradient(loss, 0.3 * rng.standard_normal(145), direction / np.linalg.norm(direction)).passed


def test_eq_7_as_printed(loss, model):
    x = 0.3 * np.random.default_rng(8).standard_normal(145)
    p = model.vertices(x[:81], x[81:])[model.landmarks]
    expected = np.linalg.norm(loss.camera.project(p) - loss.points, axis=1).sum() / loss.unit
    assert loss(x)[0] == pytest.approx(expected, rel=0.02)  # the kink at zero is rounded off
    assert loss(x)[0] < expected


def total_distance(fit, points, which=slice(None)):
    return np.linalg.norm(fit.project(fit.vertices[fit.landmark_vertices]) - points, axis=1)[which].sum()


def test_more_freedom_less_distance(points):
    fit = fit_3dmm(None, points)
    expression, both = (adjust_coefficients(fit, points, adjust) for adjust in ADJUSTMENTS)
    before, after, last = (total_distance(face, points) for face in (fit, expression, both))
    assert last < 0.7 * after < 0.7 * before
    np.testing.assert_array_equal(expression.identity, fit.identity)
    for face in (expression, both):
        assert face.camera is fit.camera
        np.testing.assert_array_equal(face.landmark_vertices, fit.landmark_vertices)
        assert 0 <= min(face.expression_weights().values()) <= max(face.expression_weights().values()) <= 1
        assert face.report.prior_loss == face.report.prior_weight == 0
        assert face.report.loss == face.report.landmark_loss
        assert fit.report.seconds < face.report.seconds < fit.report.seconds + 60
        assert face.report.evaluations > fit.report.evaluations
        misfit = (face.project(face.vertices[face.landmark_vertices]) - points)[17:]
        eyes = np.linalg.norm(points[36] - points[45])
        assert face.report.rms_px == pytest.approx(np.sqrt((misfit**2).sum(axis=1).mean()))
        assert face.report.rms_percent == pytest.approx(100 * face.report.rms_px / eyes)


@pytest.mark.parametrize("adjust", ADJUSTMENTS)
def test_the_fit_hands_on_to_it(points, adjust):
    expected = adjust_coefficients(fit_3dmm(None, points), points, adjust)
    found = fit_3dmm(None, points, adjust=adjust)
    np.testing.assert_array_equal(found.vertices, expected.vertices)


def test_missing_points_pull_nothing(points):
    holed = points.copy()
    holed[[3, 40, 66]] = np.nan
    fit = fit_3dmm(None, points)
    found, whole = (adjust_coefficients(fit, wanted, "expression") for wanted in (holed, points))
    seen = np.isfinite(holed[:, 0])
    assert total_distance(found, points, seen) < total_distance(whole, points, seen)  # with fewer points to please
    eyes = fit.project(fit.vertices[fit.landmark_vertices[[36, 45]]])
    unit = np.linalg.norm(eyes[0] - eyes[1])
    # Of each distance up to 1/1000 of the unit is rounded off at the kink.
    assert found.report.loss * unit == pytest.approx(total_distance(found, points, seen), abs=65e-3 * unit)


def test_one_gross_error_counts_once(points):
    """Without squares, moving a far point farther changes nothing but its own distance."""
    fit = fit_3dmm(None, points)
    away = np.zeros((68, 2))
    away[57, 1] = 1.0
    far, farther = (adjust_coefficients(fit, points + s * away, "expression") for s in (400, 440))
    kept = np.arange(68) != 57
    first, second = (face.project(face.vertices[face.landmark_vertices])[kept] for face in (far, farther))
    assert np.abs(first - second).max() < 2


def test_an_unknown_adjustment_lists_the_known_ones(points):
    message = "adjust: expected one of .*'expression', 'identity\\+expression', got 'pose'"
    with pytest.raises(ValueError, match=message):
        adjust_coefficients(fit_3dmm(None, points), points, "pose")
    with pytest.raises(ValueError, match=message):
        fit_3dmm(None, points, adjust="pose")


def test_an_unknown_option_lists_the_known_ones(points):
    with pytest.raises(TypeError, match="adjusted: no such option; known: landmark_weight, .*adjust"):
        fit_3dmm(None, points, adjusted="expression")
