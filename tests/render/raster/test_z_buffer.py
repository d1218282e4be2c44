"""The z-buffer in NumPy sees what OpenCV's rasterizer sees."""

import cv2
import numpy as np
import pytest

from toongeo.model import default_model
from toongeo.render import ScaledOrthographicCamera, rasterize, uv_to_px
from toongeo.render.raster import z_buffer as module


def both_ways(monkeypatch, *arguments, **options):
    """Face ids by OpenCV, and by the z-buffer."""
    if not hasattr(cv2, "triangleRasterizeColor"):
        pytest.skip("this OpenCV has no rasterizer")
    by_opencv = rasterize(*arguments, **options)
    with monkeypatch.context() as without:
        without.delattr(cv2, "triangleRasterizeColor")
        return by_opencv, rasterize(*arguments, **options)


@pytest.mark.parametrize("size", [64, 300])
@pytest.mark.parametrize(("yaw", "pitch"), [(0, 0), (40, 10), (85, 0), (180, -20)])
def test_a_head_shows_the_same_faces(yaw, pitch, size, monkeypatch):
    model = default_model()
    centre = (model.mean.min(0) + model.mean.max(0)) / 2
    camera = ScaledOrthographicCamera.look(yaw, pitch, size=size, centre=centre, extent=320)
    points = np.column_stack([camera.project(model.mean), camera.depth(model.mean)])
    fast, slow = both_ways(monkeypatch, points, model.faces, size, size)
    assert fast.mask.mean() > 0.2
    assert (fast.mask != slow.mask).mean() < 1e-3  # centres on an edge of the outline
    other = fast.mask & slow.mask & (fast.face_ids != slow.face_ids)
    assert other.sum() <= 0.001 * fast.mask.sum()
    # Where another face is seen, it lies at the same depth: an edge runs through the pixel, or two faces touch.
    depth = [
        np.einsum("pk,pk->p", found.barycentrics[other], points[model.faces[found.face_ids[other]], 2])
        for found in (fast, slow)
    ]
    np.testing.assert_allclose(depth[0], depth[1], atol=2e-4 * np.ptp(points[:, 2]))


def test_an_atlas_shows_the_same_faces(monkeypatch):
    model = default_model()
    fast, slow = both_ways(monkeypatch, uv_to_px(model.uv, 256, 256), model.uv_faces, 256, 256)
    assert (fast.face_ids == slow.face_ids).mean() > 0.999


@pytest.mark.parametrize("candidates", [1, 50, 1000])
def test_blocks_do_not_show(candidates, monkeypatch):
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.uniform(-5, 45, (600, 2)), rng.normal(size=600)])
    F = np.arange(600).reshape(-1, 3)
    monkeypatch.delattr(cv2, "triangleRasterizeColor", raising=False)
    whole = rasterize(points, F, 40, 30)
    monkeypatch.setattr(module, "_CANDIDATES", candidates)
    np.testing.assert_array_equal(rasterize(points, F, 40, 30).face_ids, whole.face_ids)


def test_faces_that_lie_on_each_other_do_not_speckle(monkeypatch):
    rng = np.random.default_rng(1)
    points = np.column_stack([rng.uniform(0, 60, (60, 2)), rng.normal(size=60)])
    F = np.arange(60).reshape(-1, 3)
    twice = np.concatenate([F, F[:, [1, 2, 0]], F[:, [2, 1, 0]]])  # the same planes, rounded otherwise
    monkeypatch.delattr(cv2, "triangleRasterizeColor", raising=False)
    once, found = rasterize(points, F, 60, 60).face_ids, rasterize(points, twice, 60, 60).face_ids
    assert (once != found).mean() < 0.01
