import dataclasses

import numpy as np
import pytest

from toongeo.caricature.align_caricature import align_caricature
from toongeo.caricature.caricature_options import CaricatureOptions
from toongeo.caricature.fit_caricature import fit_caricature
from toongeo.caricature.inner_parts import tucked
from toongeo.caricature.landmark_mesh import LandmarkMesh
from toongeo.caricature.level_camera import MOST_PITCH, level_camera
from toongeo.caricature.smooth_warp import smooth_warp, spread_rows
from toongeo.caricature.space.face_space import EXPRESSIONS, IDENTITIES, FaceSpace
from toongeo.geometry import self_intersections
from toongeo.metrics import mesh_quality
from toongeo.pipeline import align_face, fit_3dmm
from toongeo.render import PerspectiveCamera, ScaledOrthographicCamera


@pytest.fixture(scope="module")
def girl(cartoon):
    _, landmarks = cartoon("moustache_man")
    return landmarks


@pytest.fixture(scope="module")
def fit(girl, face_space):
    return fit_caricature(None, girl, space=face_space)


def test_the_space_is_the_papers(face_space):
    space = face_space.space
    assert len(space.rotations) == IDENTITIES + EXPRESSIONS == 98
    np.testing.assert_array_equal(space.reference, face_space.model.mean[face_space.vertices])
    assert not face_space.model.region("teeth_upper")[face_space.vertices].any()
    assert np.isin(np.flatnonzero(face_space.model.region("skin")), face_space.vertices).all()


def test_an_expression_goes_on_beyond_its_end(face_space):
    """w = 2 opens the mouth about twice as wide as w = 1, and sums combine."""
    space, model = face_space.space, face_space.model
    upper, lower = face_space.rows(model.landmarks[[62, 66]])

    def gap(w):
        P = space.vertices(w)
        return np.linalg.norm(P[upper] - P[lower])

    expressions, neutral = range(IDENTITIES, IDENTITIES + EXPRESSIONS), gap(np.zeros(98))
    identity = np.eye(98)[0]
    jaw = np.eye(98)[max(expressions, key=lambda k: gap(np.eye(98)[k]))]
    opened = gap(jaw) - neutral
    assert 1.6 < (gap(2 * jaw) - neutral) / opened < 2.4
    assert 0.8 < (gap(identity + jaw) - gap(identity)) / opened < 1.25


def test_unit_weights_reproduce_the_shapes(face_space):
    """Root mean square over the vertices, of the head's diagonal."""
    model, vertices = face_space.model, face_space.vertices
    space = face_space.space
    size = np.linalg.norm(np.ptp(space.reference, axis=0))
    moves = ((model.expression[: model.n_named, vertices].astype(float)) ** 2).sum((1, 2))
    chosen = np.sort(np.argsort(-moves, kind="stable")[:EXPRESSIONS])
    for k, expression in enumerate(chosen):
        P = space.vertices(np.eye(98)[IDENTITIES + k])
        shape = space.reference + model.expression[expression, vertices]
        assert np.sqrt(((P - shape) ** 2).sum(1).mean()) < 2e-4 * size


def test_reaches_the_landmarks(fit, girl):
    error = np.linalg.norm(fit.project(fit.vertices[fit.landmark_vertices]) - girl, axis=1)
    assert fit.report.rms_px == pytest.approx(np.sqrt((error**2).mean()))
    assert fit.report.rms_px < 0.03
    assert fit.report.max_px == pytest.approx(error.max())


def test_has_the_interface_of_a_fit(fit):
    assert fit.vertices.shape == fit.model.mean.shape
    assert fit.faces is fit.model.faces
    np.testing.assert_array_equal(fit.region("lips"), fit.model.region("lips"))
    np.testing.assert_allclose(np.linalg.norm(fit.normals, axis=1), 1)
    with pytest.raises(ValueError, match="read-only"):
        fit.vertices[0] = 0


def test_energy_falls(fit):
    assert fit.report.iterations == len(fit.energy) <= 4
    assert (np.diff(fit.energy) < 0).all()


def test_is_the_same_each_time(fit, girl, face_space):
    again = fit_caricature(None, girl, space=face_space)
    np.testing.assert_array_equal(again.vertices, fit.vertices)
    np.testing.assert_array_equal(again.w, fit.w)


def test_resolution_and_place_change_nothing(fit, girl, face_space):
    moved = fit_caricature(None, 3.0 * girl + [100.0, 50.0], space=face_space)
    np.testing.assert_allclose(moved.vertices, fit.vertices, atol=0.05)


def test_landmarks_of_the_mean_face_give_the_mean_face(face_space):
    model = face_space.model
    camera = ScaledOrthographicCamera.look(size=600)
    fit = fit_caricature(None, camera.project(model.mean[model.landmarks]), space=face_space)
    skin = model.region("face")
    off = fit.camera.view(fit.vertices[skin]) - camera.view(model.mean[skin])
    off -= off.mean(0)
    assert np.sqrt((off**2).sum(1).mean()) < 3.0


@pytest.mark.slow
def test_a_face_of_the_space_is_recovered_closer_than_a_3dmm_can(face_space):
    """At w = 1.5: landmarks of a face that is more extreme than its shapes."""
    model, space = face_space.model, face_space.space
    camera = ScaledOrthographicCamera.look(size=800)
    rows = face_space.rows(model.landmarks)
    skin = np.isin(face_space.vertices, np.flatnonzero(model.region("face")))
    ours, theirs = [], []
    for k in (0, 20, 40, 60):
        truth = space.vertices(1.5 * np.eye(98)[k])
        pixels = camera.project(truth[rows])
        for fit, errors in ((fit_caricature(None, pixels, space=face_space), ours), (fit_3dmm(None, pixels), theirs)):
            off = fit.camera.view(fit.vertices[face_space.vertices][skin]) * fit.camera.scale / camera.scale
            off -= camera.view(truth[skin])
            off -= off.mean(0)
            errors.append(np.sqrt((off**2).sum(1).mean()))
    assert np.mean(ours) < np.mean(theirs)


def test_goes_on_from_a_fit_with_its_camera(fit, girl, face_space):
    moved = girl.copy()
    moved[48:] += [0.0, 3.0]
    options = CaricatureOptions(tuck=False)
    warm = fit_caricature(None, moved, space=face_space, start=fit, iterations=2, options=options)
    assert warm.camera is fit.camera
    np.testing.assert_array_equal(warm.landmark_vertices, fit.landmark_vertices)
    assert warm.report.rms_px < 0.03
    change = np.linalg.norm(warm.vertices - fit.vertices, axis=1)
    assert change[fit.region("mouth")].mean() > 5 * change[fit.region("forehead")].mean()


def test_the_same_landmarks_give_nearly_the_same_face_again(fit, girl, face_space):
    again = fit_caricature(None, girl, start=fit, iterations=1)
    skin = fit.region("face")
    assert np.linalg.norm(again.vertices - fit.vertices, axis=1)[skin].max() < 1.0


def test_begins_with_an_ordinary_face_that_is_given(fit, girl, face_space):
    given = fit_caricature(None, girl, space=face_space, start=fit.fit)
    np.testing.assert_array_equal(given.vertices, fit.vertices)
    assert given.fit is fit.fit


def test_predicts_landmarks_better_than_they_are_missed_by_an_ordinary_face(girl, face_space):
    """Of 68 landmarks 23 are left out."""
    held = np.random.default_rng(0).permutation(68)[:23]
    fewer = girl.copy()
    fewer[held] = np.nan

    def error(face):
        left = (face.project(face.vertices[face.landmark_vertices]) - girl)[held]
        return np.sqrt((left**2).sum(1).mean())

    ordinary = fit_3dmm(None, fewer)
    ours = error(fit_caricature(None, fewer, space=face_space))
    assert ours < 0.8 * error(ordinary)
    assert ours < 1.1 * error(align_face(ordinary, fewer))


def test_an_aligned_caricature_is_the_caricature(fit, girl):
    face = align_caricature(fit.fit, girl)
    np.testing.assert_array_equal(face.vertices, fit.vertices)
    assert face.fit is fit.fit
    assert face.camera.scale == fit.camera.scale
    assert face.report.rms_px == fit.report.rms_px


def test_a_warp_reproduces_affine_maps_of_the_skin(face_space, rng):
    """The affine part of the spline is not smoothed."""
    A, b = np.eye(3) + 0.2 * rng.normal(size=(3, 3)), rng.normal(size=3)
    V = np.array(face_space.model.mean, np.float64)
    target = V[face_space.vertices] @ A.T + b
    warped = smooth_warp(face_space, V, target, 0.01)
    np.testing.assert_allclose(warped[face_space.vertices], target, atol=1e-6)
    outside = np.setdiff1d(np.arange(len(V)), face_space.vertices)
    np.testing.assert_array_equal(warped[outside], V[outside])


def test_a_tight_warp_takes_the_landmarks_to_their_places(face_space, rng):
    V = np.array(face_space.model.mean, np.float64)
    target = V[face_space.vertices] + np.sin(V[face_space.vertices] / 40) * 5
    rows = face_space.rows(face_space.model.landmarks)
    np.testing.assert_allclose(
        smooth_warp(face_space, V, target, 0.0)[face_space.vertices][rows], target[rows], atol=1e-6
    )


def test_spread_rows_are_the_farthest():
    line = np.stack([np.arange(11.0), np.zeros(11), np.zeros(11)], 1)
    assert spread_rows(line, 3).tolist() == [0, 10, 5]


def test_a_camera_is_levelled(rng):
    points = 50 * rng.normal(size=(68, 3))
    for yaw, pitch in ((30.0, 35.0), (-20.0, -50.0)):
        camera = ScaledOrthographicCamera.look(yaw, pitch, roll=10.0, size=500)
        level = level_camera(camera, points, camera.project(points))
        assert level.pitch == pytest.approx(np.sign(pitch) * MOST_PITCH)
        assert (level.yaw, level.roll) == pytest.approx((camera.yaw, camera.roll))
    kept = ScaledOrthographicCamera.look(30.0, 15.0, size=500)
    assert level_camera(kept, points, kept.project(points)) is kept


def test_a_levelled_camera_has_the_best_scale_and_translation(rng):
    points = 50 * rng.normal(size=(68, 3))
    camera = ScaledOrthographicCamera.look(10.0, 40.0, size=500)
    pixels = camera.project(points)
    level = level_camera(camera, points, pixels)

    def error(scale, translation):
        moved = ScaledOrthographicCamera(scale, level.rotation, translation)
        return ((moved.project(points) - pixels) ** 2).sum()

    least = error(level.scale, level.translation)
    for _ in range(10):
        assert error(level.scale * (1 + 0.01 * rng.normal()), level.translation + rng.normal(size=2)) > least


def test_missing_landmarks_hold_nothing(fit, girl, face_space):
    fewer = girl.copy()
    fewer[[30, 33]] = np.nan
    moved = fewer.copy()
    there = fit_caricature(None, fewer, space=face_space)
    assert there.report.rms_px < 0.03
    away = np.linalg.norm(there.vertices - fit.vertices, axis=1)[fit.landmark_vertices]
    assert np.delete(away, [30, 33]).max() < 3 and away[[30, 33]].max() < 15  # mm
    np.testing.assert_array_equal(fewer, moved)


def test_the_mesh_step_solves_its_equations(face_space, rng):
    """The gradient of 2 r^T (L + s L^2) r + lambda E_lan / s^2 is zero."""
    space = face_space.space
    vertices = face_space.rows(face_space.model.landmarks)
    camera = ScaledOrthographicCamera.look(yaw=25.0, pitch=-10.0, size=700)
    q = camera.project(space.reference[vertices]) + rng.normal(scale=20.0, size=(68, 2))
    weights = np.exp(rng.normal(size=68))
    u = LandmarkMesh(space, 10.0).displacements(np.zeros_like(space.reference), camera, vertices, q, weights)
    L = space.rings.laplacian
    pull = 4 * (L @ u + 10.0 * (L @ (L @ u)))
    left = camera.project(space.reference[vertices] + u[vertices]) - q
    pull[vertices] += 2 * (weights[:, None] * left / camera.scale**2) @ camera.jacobian(np.zeros((1, 3)))[0]
    np.testing.assert_allclose(pull, 0, atol=1e-7)
    np.testing.assert_allclose(u @ camera.rotation[2], 0, atol=1e-9)  # depth is left alone


def test_inner_parts_are_tucked_under_the_skin():
    skin = np.array([[-5.0, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]])
    inner = np.array([[0.0, 0, 0.2], [1, 0, -0.5], [0, 1.5, -0.5]])
    V, F = np.vstack([skin, inner]), np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6]])
    mask = np.arange(7) >= 4
    assert len(self_intersections(V, F))
    got = tucked(V, F, mask, ~mask)
    assert not len(self_intersections(got, F))
    np.testing.assert_array_equal(got[:4], V[:4])
    assert np.abs(got - V).max() < 1.1


def test_a_drawing_gives_a_sound_mesh(fit):
    face = fit.region("face")[fit.faces].all(1)
    quality = mesh_quality(fit.vertices, fit.faces, selection=face)
    assert quality.intersecting_fraction < 5e-4
    assert quality.folded_count < 3


def test_bad_input_is_refused(girl, face_space, fit, small):
    with pytest.raises(ValueError, match="img: expected"):
        fit_caricature(np.zeros((5, 5)), girl)
    with pytest.raises(ValueError, match="all points lie on one line"):
        fit_caricature(None, np.stack([np.linspace(0, 90, 68), np.linspace(0, 50, 68)], 1))
    with pytest.raises(ValueError, match="landmarks: expected 68 points"):
        fit_caricature(None, girl[:51])
    with pytest.raises(ValueError, match="weight: expected a finite number > 0, got 0"):
        fit_caricature(None, girl, weight=0)
    with pytest.raises(ValueError, match="iterations: expected at least 1, got 0"):
        fit_caricature(None, girl, iterations=0)
    with pytest.raises(ValueError, match="ridge: expected a finite number >= 0, got -1"):
        CaricatureOptions(ridge=-1)
    with pytest.raises(ValueError, match="steps: expected at least 1, got 0"):
        CaricatureOptions(steps=0)
    with pytest.raises(ValueError, match="vertices: expected one for each of the 184"):
        FaceSpace(face_space.model, small[0], np.arange(3))
    other = FaceSpace(face_space.model, face_space.space, face_space.vertices)
    with pytest.raises(ValueError, match="start: expected a fit of the same space"):
        fit_caricature(None, girl, space=other, start=fit)
    with pytest.raises(ValueError, match="start: expected a fit of the space's model"):
        fit_caricature(
            None, girl, space=face_space, start=dataclasses.replace(fit.fit, model=dataclasses.replace(fit.model))
        )
    perspective = PerspectiveCamera(800.0, np.eye(3), [0.0, 0.0, -900.0], [250.0, 250.0])
    with pytest.raises(ValueError, match="start: expected a scaled orthographic camera, got PerspectiveCamera"):
        fit_caricature(None, girl, start=dataclasses.replace(fit, camera=perspective))
    with pytest.raises(ValueError, match="vertices: expected vertices of the space"):
        face_space.rows(np.flatnonzero(face_space.model.region("tongue")))


def test_earlier_pictures_leave_no_trace(face_space, cartoon):
    """The columns of the landmarks' system are kept; which were asked for before must not show."""
    space = face_space.space
    first, second = face_space.rows(face_space.model.landmarks[:40]), face_space.rows(face_space.model.landmarks[30:])
    camera = ScaledOrthographicCamera.look(size=700)
    u0, q, weights = np.zeros_like(space.reference), np.full((38, 2), 300.0), np.ones(38)
    fresh, used = LandmarkMesh(space, 1.0), LandmarkMesh(space, 1.0)
    used.displacements(u0, camera, first, np.full((40, 2), 200.0), np.ones(40))
    np.testing.assert_array_equal(
        used.displacements(u0, camera, second, q, weights), fresh.displacements(u0, camera, second, q, weights)
    )
