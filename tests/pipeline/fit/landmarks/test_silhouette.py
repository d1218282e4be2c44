"""Jaw points on the silhouette: exact where they lie on it, mirrored with the picture, and on their lines elsewhere."""

import numpy as np
import pytest

from toongeo.geometry import vertex_normals
from toongeo.io import read_landmarks
from toongeo.model import data_path
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.visible_landmarks import visible_landmarks
from toongeo.model.ibug68 import INNER, MIRROR, PARTS
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.landmarks.silhouette import silhouette_landmarks
from toongeo.render import ScaledOrthographicCamera

JAW = PARTS["jaw"]


def found(model, camera, pixels):
    lines = visible_landmarks(landmark_basis(model), np.zeros(145), camera.rotation)
    return silhouette_landmarks(model, np.zeros(145), camera, pixels, lines), lines


@pytest.mark.parametrize("yaw", [-35, 0, 20])
def test_points_on_the_silhouette_are_their_own(model, yaw):
    camera = ScaledOrthographicCamera.look(yaw=yaw, size=700)
    guess = camera.project(model.mean[found(model, camera, np.full((68, 2), np.nan))[1]]) + [6.0, -4.0]
    moved, lines = found(model, camera, guess)
    assert (moved[JAW] != lines[JAW]).any()
    np.testing.assert_array_equal(moved[INNER], lines[INNER])
    again, _ = found(model, camera, camera.project(model.mean[moved]))
    np.testing.assert_allclose(camera.project(model.mean[again]), camera.project(model.mean[moved]))
    edge_on = (vertex_normals(model.mean, model.faces)[moved[JAW]] @ camera.rotation[2])[moved[JAW] != lines[JAW]]
    assert np.median(np.abs(edge_on)) < 0.15


def test_a_mirrored_picture_finds_the_mirrored_vertices(model):
    camera, other = (ScaledOrthographicCamera.look(yaw=yaw, size=700) for yaw in (20, -20))
    rng = np.random.default_rng(0)
    guess = camera.project(model.mean[found(model, camera, np.full((68, 2), np.nan))[1]]) + rng.normal(0, 5, (68, 2))
    moved, _ = found(model, camera, guess)
    mirrored, _ = found(model, other, (guess * [-1, 1] + [699, 0])[MIRROR])
    np.testing.assert_array_equal(model.mirror[mirrored[MIRROR]], moved)


def test_missing_points_stay_on_their_lines(model):
    moved, lines = found(model, ScaledOrthographicCamera.look(yaw=30), np.full((68, 2), np.nan))
    np.testing.assert_array_equal(moved, lines)


def test_a_fit_ends_with_its_jaw_on_the_silhouette():
    points = read_landmarks(data_path("examples/portraits/astronaut.pts"))
    lines, fit = (fit_3dmm(None, points, contour=contour) for contour in ("lines", "silhouette"))
    normals = vertex_normals(fit.vertices, fit.faces)[fit.landmark_vertices[JAW]]
    assert np.median(np.abs(normals @ fit.camera.rotation[2])) < 0.15
    assert abs(fit.camera.yaw - lines.camera.yaw) < 4
    middle = JAW[3:14]  # the ears hide the silhouette from the others

    def apart(face):
        return np.sqrt(
            (((face.project(face.vertices[face.landmark_vertices]) - points)[middle]) ** 2).sum(axis=1).mean()
        )

    assert apart(fit) < apart(lines)


def test_an_unknown_contour():
    with pytest.raises(ValueError, match="contour: expected one of 'lines', 'silhouette', got 'edges'"):
        FitOptions(contour="edges")
