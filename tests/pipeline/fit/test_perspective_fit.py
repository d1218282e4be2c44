"""The fit with a perspective camera: its gradients, recovery with a given focal length, and equivariance."""

import numpy as np
import pytest

from toongeo.io import read_landmarks
from toongeo.metrics import check_gradient
from toongeo.model import data_path
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.ibug68 import MIRROR, PARTS
from toongeo.pipeline import PriorOptions, SolverOptions
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.frame.unknowns import Unknowns
from toongeo.pipeline.fit.losses.landmark_loss import LandmarkLoss
from toongeo.render import PerspectiveCamera, ScaledOrthographicCamera

BLOCKS = ["identity", "expression", "rotation", "log_scale", "translation", "inverse_distance", "everything"]
CENTRE = (349.5, 299.5)
SIZE = np.zeros((600, 700, 3), np.uint8)


def camera(yaw=20.0, distance=450.0):
    rotation = ScaledOrthographicCamera.look(yaw=yaw, pitch=-6, roll=8).rotation
    return PerspectiveCamera(900.0, rotation, [30.0, 25.0, -distance], CENTRE)


@pytest.fixture(scope="module")
def unknowns(model):
    return Unknowns(len(model.identity), len(model.expression), perspective=True)


@pytest.fixture(scope="module")
def loss(model, unknowns):
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
        rotation0=camera().rotation,
        principal=np.array([12.0, -31.0]),
    )


@pytest.fixture(scope="module")
def x(unknowns):
    x = 0.3 * np.random.default_rng(6).standard_normal(unknowns.size)
    x[unknowns.translation] *= 20
    x[unknowns.inverse_distance] = 1 / 500
    return x


def direction(unknowns, block):
    d = np.zeros(unknowns.size)
    where = slice(None) if block == "everything" else getattr(unknowns, block)
    d[where] = np.random.default_rng(7).standard_normal(np.shape(d[where]))
    d[unknowns.inverse_distance] *= 1e-3
    return d / np.linalg.norm(d) * (1e-2 if block == "inverse_distance" else 1)


@pytest.mark.parametrize("block", BLOCKS)
def test_taylor_slope(loss, unknowns, x, block):
    assert check_gradient(loss, x, direction(unknowns, block)).passed


@pytest.mark.parametrize("block", BLOCKS)
def test_jacobian_is_the_derivative_of_the_residuals(loss, unknowns, x, block):
    d, h = direction(unknowns, block), 1e-6
    difference = (loss.residuals(x + h * d) - loss.residuals(x - h * d)) / (2 * h)
    np.testing.assert_allclose(loss.jacobian(x) @ d, difference, atol=1e-6)


def test_gradient_comes_from_the_jacobian(loss, x):
    J, e = loss.jacobian(x), loss.residuals(x)
    np.testing.assert_allclose(
        loss(x)[1], 2 / 68 * np.einsum("kin,kij,kj->n", J, loss.weights, e), rtol=1e-9, atol=1e-12
    )


def test_a_viewer_at_infinity_sees_the_orthographic_picture(loss, unknowns, x):
    flat = Unknowns(unknowns.n_identity, unknowns.n_expression)
    far = x.copy()
    far[unknowns.inverse_distance] = 0
    other = LandmarkLoss(flat, loss.points - loss.principal, loss.weights, 68, loss.mean, loss.modes, loss.rotation0)
    np.testing.assert_allclose(loss.residuals(far), other.residuals(x[:-1]), atol=1e-12)


@pytest.mark.parametrize("yaw", [-30, 0, 20])
def test_the_mean_face_is_found_with_its_pose(artist, yaw):
    points = camera(yaw).project(artist.mean[artist.landmarks])
    points[PARTS["jaw"]] = np.nan
    options = FitOptions(
        camera="perspective",
        focal_px=900.0,
        robust=None,
        solver=SolverOptions(tolerance=1e-14),
        prior=PriorOptions(pitch_deviation=1e6),
    )
    fit = fit_3dmm(SIZE, points, model=artist, options=options)
    assert fit.camera.focal_px == pytest.approx(900.0)
    np.testing.assert_array_equal(fit.camera.principal_point, CENTRE)
    assert np.abs(np.concatenate([fit.identity, fit.expression])).max() < 1e-3
    np.testing.assert_allclose(fit.camera.rotation, camera(yaw).rotation, atol=1e-4)
    np.testing.assert_allclose(fit.camera.translation, [30, 25, -450], atol=0.2)
    flat = fit_3dmm(SIZE, points, model=artist, robust=None)
    assert fit.report.rms_percent < 0.01 < flat.report.rms_percent


def test_the_focal_length_is_found_roughly_when_the_face_is_known(artist):
    points = camera(25).project(artist.mean[artist.landmarks])
    points[PARTS["jaw"]] = np.nan
    stiff = FitOptions(
        camera="perspective",
        prior_weight=1.0,
        robust=None,
        solver=SolverOptions(tolerance=1e-14),
        prior=PriorOptions(pitch_deviation=1e6),
    )
    fit = fit_3dmm(SIZE, points, model=artist, options=stiff)
    assert fit.camera.focal_px == pytest.approx(900.0, rel=0.02)
    assert -fit.camera.translation[2] == pytest.approx(450.0, rel=0.02)


@pytest.mark.parametrize("focal", [900.0, None])
def test_size_of_the_picture_changes_nothing(model, random_face, focal):
    points = camera().project(model.vertices(*random_face(2))[model.landmarks])
    first = fit_3dmm(
        None,
        points,
        camera="perspective",
        focal_px=focal,
        principal_point=CENTRE,
        solver=SolverOptions(tolerance=1e-12),
    )
    second = fit_3dmm(
        None,
        3 * points,
        camera="perspective",
        focal_px=focal and 3 * focal,
        principal_point=tuple(3 * np.array(CENTRE)),
        solver=SolverOptions(tolerance=1e-12),
    )
    np.testing.assert_allclose(second.vertices, first.vertices, atol=5e-3)
    assert second.camera.focal_px == pytest.approx(3 * first.camera.focal_px, rel=1e-3)


@pytest.mark.parametrize("picture", ["astronaut", "beethoven", "blonde_girl_threequarter", "manga_girl"])
@pytest.mark.parametrize("focal", [1200.0, None])
def test_mirrored_landmarks_give_the_mirrored_face(model, picture, focal):
    points = read_landmarks(data_path(f"examples/portraits/{picture}.pts"))
    options = FitOptions(camera="perspective", focal_px=focal)
    fit = fit_3dmm(None, points, options=options)
    other = fit_3dmm(None, (points * [-1, 1] + [999, 0])[MIRROR], options=options)
    # Vertices are summed in float32: 1e-5 mm is their rounding. At the landmarks the sums are in float64.
    np.testing.assert_allclose(other.vertices[model.mirror] * [-1, 1, 1], fit.vertices, atol=2e-5)
    basis = landmark_basis(model)
    rows = basis.rows(model.landmarks)
    here, there = (basis.positions(np.concatenate([face.identity, face.expression]))[rows] for face in (fit, other))
    np.testing.assert_allclose(there[MIRROR] * [-1, 1, 1], here, atol=1e-6)
    np.testing.assert_allclose(other.camera.translation * [-1, 1, 1], fit.camera.translation, atol=1e-6)
    np.testing.assert_allclose(other.camera.principal_point * [-1, 1] + [999, 0], fit.camera.principal_point, atol=1e-6)
    assert other.camera.yaw == pytest.approx(-fit.camera.yaw, abs=1e-6)
    assert other.camera.focal_px == pytest.approx(fit.camera.focal_px, rel=1e-6)
    np.testing.assert_array_equal(model.mirror[other.landmark_vertices[MIRROR]], fit.landmark_vertices)


def test_the_camera_meets_the_landmarks_that_the_report_says(model, random_face):
    points = camera().project(model.vertices(*random_face(3))[model.landmarks])
    fit = fit_3dmm(None, points, camera="perspective")
    projected = fit.project(fit.vertices[fit.landmark_vertices])
    assert np.sqrt(((projected - points)[17:] ** 2).sum(axis=1).mean()) == pytest.approx(fit.report.rms_px, rel=1e-4)
    both = fit_3dmm(None, points, camera="perspective", adjust="identity+expression")
    bent = both.project(both.vertices[fit.landmark_vertices])
    assert np.linalg.norm(bent - points, axis=1).sum() < np.linalg.norm(projected - points, axis=1).sum()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"camera": "fisheye"}, "camera: expected one of 'orthographic', 'perspective', got 'fisheye'"),
        ({"focal_px": 900.0}, "focal_px: expected camera='perspective' to go with it, got 'orthographic'"),
        ({"principal_point": (1.0, 2.0)}, "principal_point: expected camera='perspective'"),
        ({"camera": "perspective", "focal_px": 0.0}, "focal_px: expected a finite number > 0"),
        ({"camera": "perspective", "principal_point": (1.0,)}, "principal_point: expected 2 finite numbers"),
    ],
)
def test_bad_lenses(options, message):
    with pytest.raises(ValueError, match=message):
        FitOptions(**options)
