"""Attributes at the pixels, by OpenCV and without it."""

import cv2
import numpy as np
import pytest

from toongeo.render.raster.vertex_shader import NOTHING, VertexShader


@pytest.fixture(params=["opencv", "rows"])
def way(request, monkeypatch):
    if request.param == "rows":
        monkeypatch.delattr(cv2, "triangleRasterize", raising=False)
    elif not hasattr(cv2, "triangleRasterize"):
        pytest.skip("this OpenCV has no rasterizer")


@pytest.mark.parametrize("finer", [1, 2])
@pytest.mark.parametrize("columns", [3, 6])
def test_values_are_linear_in_the_picture_and_the_nearest_face_is_seen(way, finer, columns):
    """A slanted square, whose attributes are functions of the pixel, and a triangle before it."""
    points = np.array([[4.0, 4, -50], [60, 4, -20], [60, 60, 30], [4, 60, 0]])
    slope = np.random.default_rng(0).normal(size=(2, columns))
    before = np.array([[20.0, 20, 99], [44, 20, 99], [20, 44, 99]])
    attributes = np.vstack([points[:, :2] @ slope, np.full((3, columns), 7.0)]).astype(np.float32)
    faces = np.array([[0, 2, 1], [0, 3, 2], [4, 6, 5]], np.int32)
    shader = VertexShader(np.vstack([points, before]), attributes, 64)
    values, distance = shader.draw(faces, finer)
    assert values.shape == (64 * finer, 64 * finer, columns)
    y, x = (np.mgrid[: 64 * finer, : 64 * finer] + 0.5) / finer - 0.5
    covered = (x >= 4) & (x <= 60) & (y >= 4) & (y <= 60)
    front = (x >= 20) & (y >= 20) & (x + y <= 64)
    sure = (np.abs(x + y - 64) > 0.1) & np.isin([x, y], [4, 20, 60], invert=True).all(axis=0)
    np.testing.assert_array_equal((distance != NOTHING)[sure], covered[sure])
    expected = np.where(front[:, :, None], 7.0, np.stack([x, y], axis=2) @ slope)
    shown = covered & sure
    np.testing.assert_allclose(values[shown], expected[shown], atol=0.003 * 56 * np.abs(slope).max())
    nearest = distance[shown].min()
    assert (distance[front & sure] < nearest + 1e-6).all()
    depth = -50 + 30 * (x - 4) / 56 + 50 * (y - 4) / 56
    behind = shown & ~front
    np.testing.assert_allclose((distance[behind] - nearest) * shader.depth_unit, 99 - depth[behind], atol=0.3)


def test_no_face_covers_nothing(way):
    _, distance = VertexShader(np.zeros((3, 3)), np.zeros((3, 3), np.float32), 16).draw(np.zeros((0, 3), np.int32))
    assert (distance == NOTHING).all()
