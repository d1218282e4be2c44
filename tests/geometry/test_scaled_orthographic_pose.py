"""The closed-form pose: exact for exact data, equivariant, and refused where nothing fixes it."""

import numpy as np
import pytest

from toongeo.geometry.scaled_orthographic_pose import scaled_orthographic_pose
from toongeo.render import ScaledOrthographicCamera


@pytest.fixture
def points():
    return np.random.default_rng(3).normal(0, [40, 50, 15], (30, 3))


@pytest.mark.parametrize("yaw", [-90, -40, 0, 25, 90])
@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_exact_projections_give_the_camera_back(points, yaw, scale):
    camera = ScaledOrthographicCamera.look(yaw=yaw, pitch=-12, roll=33).scaled(scale)
    found = scaled_orthographic_pose(points, camera.project(points))
    np.testing.assert_allclose(found[0], camera.scale, rtol=1e-12)
    np.testing.assert_allclose(found[1], camera.rotation, atol=1e-12)
    np.testing.assert_allclose(found[2], camera.translation, rtol=1e-10)


def test_noise_keeps_the_rotation_proper(points):
    pixels = np.random.default_rng(0).normal(0, 100, (30, 2))
    rotation = scaled_orthographic_pose(points, pixels)[1]
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1)


@pytest.mark.parametrize("slope", [0.0, 0.7])
def test_pixels_on_a_line_are_refused(points, slope):
    x = points[:, 0]
    with pytest.raises(ValueError, match="landmarks: expected points spread over a face, got .* line"):
        scaled_orthographic_pose(points, np.column_stack([x, slope * x + 5]))


def test_pixels_in_one_place_are_refused(points):
    with pytest.raises(ValueError, match="points on a line"):
        scaled_orthographic_pose(points, np.full((30, 2), 7.0))


def test_a_weight_counts_as_so_many_points(points, rng):
    pixels = ScaledOrthographicCamera.look(yaw=20).project(points) + rng.normal(0, 5, (30, 2))
    counts = rng.integers(0, 5, 30)
    weighted = scaled_orthographic_pose(points, pixels, 0.1 * counts)
    repeated = scaled_orthographic_pose(np.repeat(points, counts, axis=0), np.repeat(pixels, counts, axis=0))
    for found, expected in zip(weighted, repeated, strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-12)
