"""The coarse fit: recovery of what is known, equivariance, missing points, real drawings, and bad input."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.io import read_landmarks
from toongeo.model import data_path
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.visible_landmarks import visible_landmarks
from toongeo.model.ibug68 import INNER, MIRROR, OUTER_EYES, PARTS
from toongeo.model.opposites import OPPOSITES
from toongeo.pipeline import JawOptions, PriorOptions, SolverOptions
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.problem.starting_problem import starting_problem
from toongeo.render import ScaledOrthographicCamera

PICTURES = [
    "astronaut", "bad_guy", "beethoven", "blonde_girl_threequarter", "blue_girl", "manga_girl",
    "moustache_man",
]  # fmt: skip
TIGHT = FitOptions(solver=SolverOptions(tolerance=1e-13), prior=PriorOptions(pitch_deviation=1e6))


def drawing(name):
    return read_landmarks(data_path(f"examples/portraits/{name}.pts"))


def coefficients(fit):
    return np.concatenate([fit.identity, fit.expression])


@pytest.fixture(scope="module")
def face():
    return drawing("astronaut")


# --- recovery ---


@pytest.mark.parametrize("yaw", [-40, -20, 0, 15, 40])
def test_the_mean_face_is_found_with_its_pose(artist, annotated, yaw):
    camera = ScaledOrthographicCamera.look(yaw=yaw, pitch=8, roll=-12, size=700)
    fit = fit_3dmm(None, annotated(artist, camera), model=artist, options=TIGHT)
    assert np.abs(coefficients(fit)).max() < 1e-5
    np.testing.assert_allclose(fit.camera.rotation, camera.rotation, atol=1e-6)
    np.testing.assert_allclose(fit.camera.scale, camera.scale, rtol=1e-6)
    np.testing.assert_allclose(fit.camera.translation, camera.translation, atol=1e-4)


@pytest.mark.parametrize("seed", range(4))
def test_a_known_face_is_met_exactly_when_the_prior_is_weak(model, annotated, random_face, seed):
    camera = ScaledOrthographicCamera.look(yaw=15 * seed - 25, pitch=5)
    pixels = annotated(model, camera, *random_face(seed))
    pixels[PARTS["jaw"]] = np.nan  # without sliding points the loss is smooth, and zero at the truth
    errors = [
        fit_3dmm(
            None,
            pixels,
            options=FitOptions(
                prior_weight=w, solver=SolverOptions(tolerance=1e-9), prior=PriorOptions(pitch_deviation=1e6)
            ),
        ).report.rms_percent
        for w in (1e-6, 1e-8)
    ]
    assert errors[1] < 0.1
    assert errors[1] < 0.2 * errors[0]


@pytest.mark.parametrize("yaw", [-40, -20, 0, 20, 40])
def test_the_pose_of_a_stranger_is_found(model, annotated, random_face, yaw):
    camera = ScaledOrthographicCamera.look(yaw=yaw, pitch=-8, roll=10)
    found = [fit_3dmm(None, annotated(model, camera, *random_face(seed))).camera for seed in range(8)]
    assert np.abs([c.yaw - camera.yaw for c in found]).mean() < 4
    assert np.abs([c.roll - camera.roll for c in found]).mean() < 2
    assert (
        np.abs([c.scale / camera.scale - 1 for c in found]).mean() < 0.05
    )  # the likeliest face is larger than the mean they are drawn about


def test_a_stronger_prior_is_a_smaller_face_and_a_larger_error(model, face):
    fits = [fit_3dmm(None, face, options=FitOptions(prior_weight=w)) for w in (1e-7, 1e-5, 1e-3)]
    assert np.all(np.diff([fit.report.prior_loss for fit in fits]) < 0)
    assert np.all(np.diff([fit.report.landmark_loss for fit in fits]) > 0)


def test_the_minimum_is_one(model, face):
    """No small step within the bounds lowers the loss of a pass."""
    problem = starting_problem(model, face, FitOptions(solver=SolverOptions(tolerance=1e-14, max_passes=1)))
    apart = replace(problem.search, opposites=problem.search.opposites[:0])  # these are parted after a pass
    problem = replace(problem, search=apart)
    fit = problem.solve("gauss-newton")
    placed = visible_landmarks(problem.basis, problem.search.start[:145], problem.frame.rotation0)
    loss = problem.loss(placed, problem.options.prior_weight, problem.target.robust_weight)
    x = np.zeros(problem.unknowns.size)
    x[problem.unknowns.shape] = fit.coefficients
    # The pose is optimal for these coefficients: find it again from the camera.
    relative = problem.frame.roll.T @ fit.camera.rotation @ problem.frame.rotation0.T
    x[problem.unknowns.rotation] = Rotation.from_matrix(relative).as_rotvec()
    x[problem.unknowns.log_scale] = np.log(fit.camera.scale / problem.frame.scale)
    x[problem.unknowns.translation] = problem.frame.from_pixels(fit.camera.translation[None])[0]
    value, gradient = loss(x)
    assert value == pytest.approx(fit.loss, rel=1e-12)
    lower, upper = problem.search.bounds
    free = np.where((x > lower) & (gradient > 0) | (x < upper) & (gradient < 0), gradient, 0)
    assert np.abs(free / np.sqrt(loss.curvature(x))).max() < 1e-6


@pytest.mark.parametrize("algorithm", ["LD_LBFGS", "LD_VAR2", "LD_TNEWTON_PRECOND_RESTART", "LD_CCSAQ"])
def test_other_optimizers_find_the_same_face(face, algorithm):
    options = FitOptions(solver=SolverOptions(tolerance=1e-12, max_passes=1, max_evaluations=20000))
    expected, found = (fit_3dmm(None, face, algorithm=a, options=options) for a in ("gauss-newton", algorithm))
    assert found.report.algorithm == algorithm
    assert found.report.loss == pytest.approx(expected.report.loss, rel=1e-4)
    np.testing.assert_allclose(coefficients(found), coefficients(expected), atol=0.02)


# --- equivariance ---


@pytest.mark.parametrize("picture", ["astronaut", "manga_girl"])
@pytest.mark.parametrize("scale", [1e-1, 3.7, 1e4])
def test_size_place_and_tilt_in_the_picture_change_nothing(picture, scale):
    points = drawing(picture)
    turned = ScaledOrthographicCamera.look(roll=-35).rotation[:2, :2]
    shift = np.array([812.0, -95.0])
    fit, other = fit_3dmm(None, points), fit_3dmm(None, scale * points @ turned.T + shift)
    np.testing.assert_allclose(coefficients(other), coefficients(fit), atol=1e-5)
    np.testing.assert_array_equal(other.landmark_vertices, fit.landmark_vertices)
    assert other.camera.scale == pytest.approx(scale * fit.camera.scale, rel=1e-6)
    np.testing.assert_allclose(
        other.project(other.vertices), scale * fit.project(fit.vertices) @ turned.T + shift, atol=1e-4 * scale
    )
    assert other.report.rms_percent == pytest.approx(fit.report.rms_percent, rel=1e-5)


@pytest.mark.parametrize("picture", PICTURES)
def test_mirrored_landmarks_give_the_mirrored_face(model, picture):
    points = drawing(picture)
    fit = fit_3dmm(None, points)
    other = fit_3dmm(None, (points * [-1, 1] + [999, 0])[MIRROR])
    # Vertices are summed in float32: 1e-5 mm is their rounding.
    np.testing.assert_allclose(other.vertices[model.mirror] * [-1, 1, 1], fit.vertices, atol=2e-5)
    assert other.camera.yaw == pytest.approx(-fit.camera.yaw, abs=1e-6)
    np.testing.assert_array_equal(model.mirror[other.landmark_vertices[MIRROR]], fit.landmark_vertices)


def test_twice_the_same_to_the_last_bit(face):
    first, second = fit_3dmm(None, face), fit_3dmm(None, face)
    assert first.vertices.tobytes() == second.vertices.tobytes()
    assert replace(first.report, seconds=0.0) == replace(second.report, seconds=0.0)


# --- missing points ---


@pytest.mark.parametrize(
    "missing",
    [
        PARTS["jaw"],
        PARTS["eye_left"],
        np.concatenate([PARTS["mouth"], PARTS["brow_left"]]),
        np.arange(0, 68, 2),
    ],
    ids=["jaw", "one eye", "mouth and brow", "every second"],
)
def test_missing_points_leave_a_face_that_meets_the_rest(face, missing):
    points = face.copy()
    points[missing] = np.nan
    fit, whole = fit_3dmm(None, points), fit_3dmm(None, face)
    assert np.isfinite(fit.vertices).all()
    assert fit.report.rms_percent < whole.report.rms_percent + 0.5
    unit = np.linalg.norm(np.subtract(*face[list(OUTER_EYES)]))
    guessed = fit.project(fit.vertices[fit.landmark_vertices])[INNER]
    assert np.sqrt(((guessed - face[INNER]) ** 2).sum(axis=1).mean()) < 0.06 * unit


def test_a_missing_point_is_a_point_of_no_weight(face):
    """The jaw missing, and the jaw weighing nothing, are the same fit."""
    points = face.copy()
    points[PARTS["jaw"]] = np.nan
    options = FitOptions(jaw=JawOptions(weight=0.0), solver=SolverOptions(max_passes=1))
    np.testing.assert_allclose(
        coefficients(fit_3dmm(None, points, options=options)),
        coefficients(fit_3dmm(None, face, options=options)),
        atol=1e-6,
    )


def test_the_error_needs_no_eye_corners(face):
    points = face.copy()
    points[list(OUTER_EYES)] = np.nan
    with_corners, without = fit_3dmm(None, face).report, fit_3dmm(None, points).report
    assert without.rms_percent == pytest.approx(with_corners.rms_percent, rel=0.1)


def test_a_jaw_alone_has_no_inner_error(face):
    points = np.full((68, 2), np.nan)
    points[PARTS["jaw"]] = face[PARTS["jaw"]]
    assert np.isnan(fit_3dmm(None, points).report.rms_px)


# --- real drawings ---


@pytest.mark.parametrize("picture", PICTURES)
def test_drawings_give_plausible_faces(model, picture):
    fit = fit_3dmm(None, drawing(picture))
    weights = fit.expression_weights()
    away = fit.identity - model.prior.mean
    assert np.abs(away).max() <= 3 and np.abs(fit.expression).max() <= 3
    assert min(weights.values()) >= 0
    assert max(weights.values()) <= 1
    assert weights["mouthClose"] == 0
    assert all(min(weights[a], weights[b]) == 0 for a, b in OPPOSITES)
    assert max(weights["eyeBlinkLeft"], weights["eyeBlinkRight"]) < 0.5
    assert np.abs(away).mean() < 0.8
    assert abs(fit.camera.yaw) < 25
    # No face of the model looks like these; the prior keeps it a face and leaves the rest to the alignment.
    assert fit.report.rms_percent < (16 if picture == "beethoven" else 9)


@pytest.mark.parametrize("portrait", ["einstein", "image_0010", "takeo"])
def test_portraits_are_met_within_four_percent(shared, portrait):
    fit = fit_3dmm(None, read_landmarks(shared / "data" / "portraits" / f"{portrait}.pts"))
    assert fit.report.rms_percent <= 4


def test_a_smile_is_seen(face):
    weights = fit_3dmm(None, face).expression_weights()
    assert min(weights["mouthSmileLeft"], weights["mouthSmileRight"]) > 0.3


def test_the_reported_error_is_that_of_the_projected_vertices(face):
    fit = fit_3dmm(None, face)
    projected = fit.project(fit.vertices[fit.landmark_vertices])
    unit = np.linalg.norm(np.subtract(*face[list(OUTER_EYES)]))
    rms = np.sqrt(((projected - face)[INNER] ** 2).sum(axis=1).mean())
    assert rms <= 0.04 * unit
    assert fit.report.rms_px == pytest.approx(rms, rel=1e-5)
    assert fit.report.rms_percent == pytest.approx(100 * rms / unit, rel=1e-5)


# --- what comes out ---


def test_the_result(model, face):
    fit = fit_3dmm(np.zeros((600, 600, 3), np.uint8), face)
    assert (fit.identity.shape, fit.expression.shape, fit.landmark_vertices.shape) == ((81,), (64,), (68,))
    assert fit.model is model
    assert fit.faces is model.faces
    assert fit.albedo is None and fit.light is None
    np.testing.assert_array_equal(fit.vertices, model.vertices(fit.identity, fit.expression))
    assert fit.vertices is fit.vertices
    np.testing.assert_array_equal(fit.region("lips"), model.region("lips"))
    np.testing.assert_array_equal(fit.project(fit.vertices), fit.camera.project(fit.vertices))
    basis = landmark_basis(model)
    np.testing.assert_array_equal(
        fit.landmark_vertices, visible_landmarks(basis, coefficients(fit), fit.camera.rotation)
    )
    report = fit.report
    assert report.status == "FTOL_REACHED"
    assert report.loss == pytest.approx(
        FitOptions().landmark_weight * report.landmark_loss + report.prior_weight * report.prior_loss
    )
    assert report.prior_weight == FitOptions().prior_weight  # a photograph's misfit is what the prior expects
    assert report.passes >= 1 and report.evaluations > 3 and report.seconds > 0


def test_the_prior_counts_more_where_no_face_of_the_model_fits():
    report = fit_3dmm(None, drawing("beethoven")).report
    assert report.prior_weight > 2 * FitOptions().prior_weight
    expected = FitOptions().landmark_weight * report.landmark_loss + report.prior_weight * report.prior_loss
    assert report.loss == pytest.approx(expected)


def test_arrays_of_the_result_are_read_only(face):
    fit = fit_3dmm(None, face)
    for array in (fit.identity, fit.expression, fit.landmark_vertices, fit.vertices):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_arguments_are_not_written_to(face):
    before = face.copy()
    fit_3dmm(None, face)
    np.testing.assert_array_equal(face, before)


def test_a_single_pass_gives_no_opposite_expressions_either():
    weights = fit_3dmm(None, drawing("blue_girl"), solver=SolverOptions(max_passes=1)).expression_weights()
    assert all(min(weights[a], weights[b]) == 0 for a, b in OPPOSITES)


def test_a_stop_after_few_evaluations_says_so(face):
    report = fit_3dmm(None, face, options=FitOptions(solver=SolverOptions(max_evaluations=3, max_passes=1))).report
    assert report.status == "MAXEVAL_REACHED"
    assert report.evaluations == 3


def test_a_stop_after_too_long_says_so(face):
    report = fit_3dmm(None, face, options=FitOptions(solver=SolverOptions(max_seconds=1e-9, max_passes=1))).report
    assert report.status == "MAXTIME_REACHED"


def test_doubts_about_the_landmarks_are_handed_on(face):
    size = int(face.max()) - 5  # the outermost point is just outside
    report = fit_3dmm(np.zeros((size, size, 3), np.uint8), face).report
    assert any("outside" in warning for warning in report.warnings)


# --- bad input ---


def test_bad_landmarks(face):
    def holed(kept):
        points = np.full((68, 2), np.nan)
        points[list(kept)] = face[list(kept)]
        return points

    infinite = face.copy()
    infinite[3, 1] = np.inf
    for landmarks, message in [
        (face[:51], "landmarks: expected 68 points"),
        (np.zeros((68, 3)), r"landmarks: expected shape \(68, 2\)"),
        (holed([]), "landmarks: .* NaN"),
        (holed([30, 31, 36, 45, 48]), "landmarks: expected at least 6 points"),
        (np.full((68, 2), 7.0), "landmarks: "),
        (np.column_stack([np.arange(68), np.arange(68)]).astype(float), "landmarks: .*line"),
        (infinite, "landmarks: expected finite"),
        (face * [-1, 1] + [600, 0], "landmarks: .*mirrored"),
        (face.astype(str), "landmarks: expected numbers, got an array of <U"),
        (face + 1j, "landmarks: expected numbers, got an array of complex128"),
        ([[1, 2], [3]], "landmarks: expected 68 rows of x and y, got rows of different lengths"),
    ]:
        with pytest.raises(ValueError, match=message):
            fit_3dmm(None, landmarks)


def test_landmarks_of_another_picture(face):
    with pytest.raises(ValueError, match="landmarks: .*outside"):
        fit_3dmm(np.zeros((100, 100, 3), np.uint8), face + 5000)


@pytest.mark.parametrize("shape", [(0, 0, 3), (0, 40, 3), (40, 40), (40, 40, 4), (3,)])
def test_pictures_of_another_shape(face, shape):
    with pytest.raises(ValueError, match=r"img: expected \(H, W, 3\) uint8 RGB, got uint8 of shape"):
        fit_3dmm(np.zeros(shape, np.uint8), face)


@pytest.mark.parametrize("value", [np.nan, np.inf, 0.5, True])
def test_pictures_that_are_not_bytes(face, value):
    with pytest.raises(ValueError, match=r"img: expected \(H, W, 3\) uint8 RGB, got (float64|bool) of shape"):
        fit_3dmm(np.full((600, 600, 3), value), face)


def test_an_unknown_algorithm(face):
    with pytest.raises(ValueError, match="algorithm: no algorithm 'LM'; known: gauss-newton, .*LD_LBFGS"):
        fit_3dmm(None, face, algorithm="LM")


def test_an_algorithm_that_cannot(face):
    with pytest.raises(RuntimeError, match="GN_AGS: nlopt failed"):
        fit_3dmm(None, face, algorithm="GN_AGS")


def test_a_model_without_the_68_landmarks(model, face):
    with pytest.raises(ValueError, match="landmarks: expected 68 rows, got 51"):
        fit_3dmm(None, face, model=replace(model, landmarks=model.landmarks[17:]))
    with pytest.raises(ValueError, match="got 68 landmarks and 16 lines"):
        fit_3dmm(None, face, model=replace(model, contour_lines=model.contour_lines[:16]))


@pytest.mark.parametrize(
    ("group", "name", "value", "message"),
    [
        (FitOptions, "prior_weight", -1.0, "prior_weight: expected a finite number > 0, got -1.0"),
        (FitOptions, "landmark_weight", 0.0, "landmark_weight: expected a finite number > 0, got 0.0"),
        (FitOptions, "prior_weight", "1", "prior_weight: expected a finite number > 0, got '1'"),
        (FitOptions, "prior_weight", True, "prior_weight: expected a finite number > 0, got True"),
        (FitOptions, "refine", 1, "refine: expected one of True, False, got 1"),
        (FitOptions, "prior", 1.0, "prior: expected PriorOptions, got float"),
        (FitOptions, "solver", JawOptions(), "solver: expected SolverOptions, got JawOptions"),
        (PriorOptions, "expression_weight", float("nan"), "expression_weight: expected a finite number > 0"),
        (PriorOptions, "pitch_deviation", 0.0, "pitch_deviation: expected a finite number > 0, got 0.0"),
        (JawOptions, "weight", -0.1, "weight: expected a finite number >= 0, got -0.1"),
        (JawOptions, "tangent", 1.5, r"tangent: expected a number in \[0, 1\], got 1.5"),
        (SolverOptions, "max_passes", 0, "max_passes: expected an integer >= 1, got 0"),
        (SolverOptions, "max_evaluations", 10.5, "max_evaluations: expected an integer >= 1, got 10.5"),
        (SolverOptions, "tolerance", float("inf"), "tolerance: expected a finite number > 0"),
        (SolverOptions, "max_seconds", 0.0, "max_seconds: expected a finite number > 0, got 0.0"),
    ],
)
def test_bad_options(group, name, value, message):
    with pytest.raises(ValueError, match=message):
        group(**{name: value})
