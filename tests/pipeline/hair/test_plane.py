import dataclasses

import numpy as np
import pytest

from toongeo.pipeline.hair.plane.depth_maps import ball_offset
from toongeo.pipeline.hair.plane.masks import (
    closed,
    depth_inside,
    large_pieces,
    nearest_set,
    opened,
    signed,
    without_holes,
)
from toongeo.pipeline.hair.plane.working_plane import CELL_MM, working_plane
from toongeo.render import ScaledOrthographicCamera


@pytest.fixture(scope="module")
def plane(avatar, mask):
    camera = ScaledOrthographicCamera(1.7, turn(30, 10, 20), np.array([150.0, 200.0]))
    return working_plane(dataclasses.replace(avatar.face, camera=camera), mask), camera


def turn(yaw, pitch, roll):
    a, b, c = np.deg2rad([yaw, pitch, roll])
    Ry = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    Rx = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
    Rz = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    return Rz @ Rx @ Ry


def test_plane_is_the_cameras_without_roll(plane, rng):
    where, camera = plane
    X = rng.normal(0, 60, (20, 3))
    inside = where.of(X)
    np.testing.assert_allclose(where.back(inside), X, atol=1e-9)
    np.testing.assert_allclose(where.px(inside[:, :2]), camera.project(X), atol=1e-9)
    np.testing.assert_allclose(where.xy(camera.project(X)), inside[:, :2], atol=1e-9)
    np.testing.assert_allclose(inside[:, 2], camera.depth(X), atol=1e-9)
    up = where.of(np.array([[0.0, 1.0, 0.0]]))[0]
    assert abs(up[0]) < 1e-9 < up[1]  # upright, as only yaw and pitch are left


def test_warp_and_sample_agree(plane):
    where, _ = plane
    x, y = np.meshgrid(np.arange(336.0), np.arange(400.0))
    raster = where.warp((x + 2 * y).astype(np.float32))
    xy = np.array([[0.0, 0.0], [13.0, -7.0], [-20.0, 31.0]])
    px = where.px(xy)
    np.testing.assert_allclose(where.sample(raster, xy), px[:, 0] + 2 * px[:, 1], rtol=1e-2)


def test_ball_offset_of_a_point_is_a_ball():
    front = np.full((21, 21), -np.inf)
    front[10, 10] = 5.0
    raised = ball_offset(front, 8.0)
    y, x = (np.mgrid[:21, :21] - 10) * CELL_MM
    inside = x * x + y * y <= 64
    np.testing.assert_allclose(raised[inside], 5 + np.sqrt(64 - (x * x + y * y)[inside]))
    assert (raised[~inside] == -np.inf).all()


def test_distances_and_shapes():
    mask = np.zeros((60, 60), bool)
    mask[10:50, 10:50] = True
    mask[30, 10:50] = False  # a slit
    assert depth_inside(mask)[12, 30] == pytest.approx(3 * CELL_MM)
    assert (signed(mask) > 0).sum() == mask.sum()
    assert closed(mask, 2 * CELL_MM)[30, 20:40].all()
    mask[5, 5] = True
    assert not opened(mask, 2 * CELL_MM)[5, 5]
    assert not large_pieces(mask, 0.02)[5, 5]
    ring = np.zeros((20, 20), bool)
    ring[4:16, 4:16] = True
    ring[8:12, 8:12] = False
    assert without_holes(ring)[9, 9]
    assert not without_holes(ring, 10.0)[9, 9]
    assert not without_holes(ring)[0, 0]


def test_nearest_set():
    values = np.arange(25.0).reshape(5, 5)
    known = np.zeros((5, 5), bool)
    known[0, 0] = known[4, 4] = True
    spread = nearest_set(values, known)
    assert spread[1, 1] == 0
    assert spread[3, 4] == 24
    np.testing.assert_array_equal(nearest_set(values, known & False), values)
