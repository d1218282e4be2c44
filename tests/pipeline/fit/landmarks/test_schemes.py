"""Landmark schemes: parts of iBUG-68 by name, and tables of one's own."""

import numpy as np
import pytest

from toongeo.io import read_landmarks
from toongeo.model import data_path
from toongeo.model.ibug68 import INNER
from toongeo.model.mediapipe478 import VERTICES
from toongeo.pipeline import SolverOptions
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.ibug_landmarks import ibug_landmarks
from toongeo.render import ScaledOrthographicCamera

PARTS_OF_IBUG = {"ibug68": np.arange(68), "ibug51": INNER, "ibug49": INNER[~np.isin(INNER, [60, 64])]}
CAMERA = ScaledOrthographicCamera.look(yaw=18, pitch=-6, roll=9, size=600)


@pytest.fixture(scope="module")
def points():
    return read_landmarks(data_path("examples/portraits/astronaut.pts"))


@pytest.mark.parametrize("scheme", PARTS_OF_IBUG)
def test_a_scheme_is_68_points_of_which_some_are_missing(points, scheme):
    holed = np.full((68, 2), np.nan)
    holed[PARTS_OF_IBUG[scheme]] = points[PARTS_OF_IBUG[scheme]]
    assert len(PARTS_OF_IBUG[scheme]) == int(scheme.removeprefix("ibug"))
    np.testing.assert_array_equal(ibug_landmarks(points[PARTS_OF_IBUG[scheme]], scheme), holed)
    found = fit_3dmm(None, points[PARTS_OF_IBUG[scheme]], scheme=scheme)
    np.testing.assert_array_equal(found.vertices, fit_3dmm(None, holed).vertices)


@pytest.mark.parametrize("count", [468, 478])
def test_a_face_mesh_is_the_68_points_that_the_table_names(points, count):
    mesh = np.random.default_rng(0).uniform(0, 1000, (count, 2))
    mesh[VERTICES] = points
    np.testing.assert_array_equal(ibug_landmarks(mesh, "mediapipe478"), points)
    found, same = fit_3dmm(None, mesh, scheme="mediapipe478"), fit_3dmm(None, points)
    np.testing.assert_array_equal(found.vertices, same.vertices)
    assert found.report.rms_px == same.report.rms_px


def test_a_face_mesh_of_another_size_or_in_shares_of_the_picture(points):
    wanted = r"landmarks: expected shape \(478, 2\) or \(468, 2\) px for scheme 'mediapipe478', got "
    with pytest.raises(ValueError, match=wanted + r"\(68, 2\)"):
        fit_3dmm(None, points, scheme="mediapipe478")
    with pytest.raises(ValueError, match=wanted + r"\(478, 3\)"):
        fit_3dmm(None, np.zeros((478, 3)), scheme="mediapipe478")
    with pytest.raises(ValueError, match="landmarks: expected numbers, got an array of complex128"):
        fit_3dmm(None, np.zeros((478, 2), complex), scheme="mediapipe478")
    with pytest.raises(ValueError, match="landmarks: expected at least one point, but all rows are NaN"):
        fit_3dmm(None, np.full((478, 2), np.nan), scheme="mediapipe478")
    shares = np.zeros((478, 2))
    shares[VERTICES] = points / 1000
    with pytest.raises(ValueError, match="landmarks: expected a face in pixels"):
        fit_3dmm(None, shares, scheme="mediapipe478")


def test_an_unknown_scheme_lists_the_known_ones(points):
    with pytest.raises(ValueError, match="scheme: expected one of 'ibug68', 'ibug51', .*'mediapipe478', got 'wflw97'"):
        fit_3dmm(None, points, scheme="wflw97")
    with pytest.raises(ValueError, match="scheme: expected one of 'ibug68', .*or a table, got 'wflw97'"):
        ibug_landmarks(points, "wflw97")
    with pytest.raises(ValueError, match=r"landmarks: expected shape \(51, 2\) px for scheme 'ibug51', got \(68, 2\)"):
        fit_3dmm(None, points, scheme="ibug51")


def test_a_table_of_the_inner_vertices_is_the_scheme_of_these(artist, points):
    """Where the model does not know the noise of each landmark; up to N in Eq. 4, which the weights undo."""
    options = FitOptions(robust=None, solver=SolverOptions(max_passes=1, tolerance=1e-12))
    named = fit_3dmm(None, points[INNER], model=artist, scheme="ibug51", options=options)
    table = artist.landmarks[INNER]
    own = fit_3dmm(None, points[INNER], model=artist, scheme=table, options=options, landmark_weight=51 / 68)
    np.testing.assert_allclose(own.vertices, named.vertices, atol=2e-3)
    assert own.report.rms_px == pytest.approx(named.report.rms_px, rel=1e-3)


@pytest.fixture(scope="module")
def spots(model):
    """Random points in triangles of the face, as faces and weights."""
    rng = np.random.default_rng(2)
    front = np.flatnonzero(model.region("face")[model.faces].all(axis=1))
    return rng.choice(front, 120, replace=False), rng.dirichlet(np.ones(3), 120)


def test_barycentric_points_give_the_face_that_they_lie_on(model, spots, random_face):
    V = model.vertices(*random_face(4))
    faces, weights = spots
    pixels = CAMERA.project(np.einsum("kvj,kv->kj", V[model.faces[faces]], weights))
    pixels[::9] = np.nan
    fit = fit_3dmm(None, pixels, scheme=(faces, weights), prior_weight=1e-8)
    assert fit.report.rms_percent < 0.1
    assert fit.landmark_vertices.shape == (68,)
    assert fit.camera.yaw == pytest.approx(18, abs=2)
    corners = fit_3dmm(None, CAMERA.project(V[model.faces[faces, 0]]), scheme=model.faces[faces, 0])
    assert corners.report.rms_percent < 2


def test_outliers_in_a_table_are_found(model, spots):
    faces, weights = spots
    pixels = CAMERA.project(np.einsum("kvj,kv->kj", model.mean[model.faces[faces]], weights))
    clean = fit_3dmm(None, pixels, scheme=spots)
    pixels[[3, 50, 77]] += [150, -90]
    fit = fit_3dmm(None, pixels, scheme=spots)
    assert fit.report.outliers == (3, 50, 77)
    assert np.linalg.norm(fit.vertices - clean.vertices, axis=1).max() < 0.8


def test_bad_tables(model, points):
    for scheme, message in [
        (np.arange(5), r"scheme: expected at least 6 vertices \(k,\) as integers, got shape \(5,\)"),
        (np.linspace(0, 1, 68), "scheme: expected at least 6 vertices .* of float64"),
        (np.arange(68) - 1, r"scheme: expected vertices in 0\.\.\d+, got -1\.\.66"),
        ((np.full(68, 10**7), np.full((68, 3), 1 / 3)), r"scheme: expected faces in 0\.\."),
        ((np.arange(68), np.full((67, 3), 1 / 3)), r"scheme: expected weights of shape \(68, 3\), got \(67, 3\)"),
        ((np.arange(68), np.ones((68, 3))), "scheme: expected barycentric weights that sum to 1"),
        ((np.arange(68), np.full((68, 3), np.nan)), "scheme: expected barycentric weights that sum to 1"),
        ((np.arange(68), np.tile([np.inf, -np.inf, 1], (68, 1))), "scheme: expected barycentric weights that sum to 1"),
        ((np.arange(68), np.full((68, 3), "a")), "scheme: expected numbers, got an array of <U1"),
        ((np.arange(6), [[1, 2], [3]]), r"scheme: expected weights \(k, 3\), got rows of different lengths"),
        ([[1, 2], [3]], "scheme: expected vertices .* as integers, got rows of different lengths"),
        (None, r"scheme: expected at least 6 vertices .*, got shape \(\) of object"),
    ]:
        with pytest.raises(ValueError, match=message):
            fit_3dmm(None, points, scheme=scheme)
    with pytest.raises(ValueError, match="adjust: expected a scheme by name to go with it, got a table"):
        FitOptions(scheme=model.landmarks, adjust="expression")


def test_bad_landmarks_of_a_table(model, points):
    half, infinite, few = points.copy(), points.copy(), points.copy()
    half[3, 1], infinite[3, 1], few[5:] = np.nan, np.inf, np.nan
    for landmarks, message in [
        (points[:60], r"landmarks: expected shape \(68, 2\) to go with scheme, got \(60, 2\)"),
        (half, "landmarks: expected finite px, or NaN in both coordinates"),
        (infinite, "landmarks: expected finite px, or NaN in both coordinates"),
        (few, "landmarks: expected at least 6 points that are not NaN, got 5"),
        (points.astype(str), "landmarks: expected numbers, got an array of <U"),
    ]:
        with pytest.raises(ValueError, match=message):
            fit_3dmm(None, landmarks, scheme=model.landmarks)
