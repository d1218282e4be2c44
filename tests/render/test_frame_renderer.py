"""Frames of a film beside pictures of the same surfaces."""

import numpy as np
import pytest

from toongeo.render import FrameRenderer, ScaledOrthographicCamera, Surface, render_mesh, studio_light


def ball(radius, centre, count=24):
    """Sphere with a seam in its uv, and a texture of stripes."""
    u, v = np.meshgrid(np.linspace(0, 1, count + 1), np.linspace(0.02, 0.98, count + 1))
    turn, tilt = 2 * np.pi * u.ravel(), np.pi * v.ravel()
    points = np.column_stack([-np.cos(turn) * np.sin(tilt), np.cos(tilt), np.sin(turn) * np.sin(tilt)])
    i = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    faces = np.vstack(
        [np.column_stack([i, i + count + 1, i + 1]), np.column_stack([i + 1, i + count + 1, i + count + 2])]
    )
    waves = np.cos(2 * np.pi * np.arange(64) / 16)
    stripes = np.rint(128 + 60 * waves[None, :, None] * [1, 0.2, -1]).astype(np.uint8).repeat(64, axis=0)
    uv = np.column_stack([u.ravel(), 1 - v.ravel()])
    return Surface(radius * points + centre, faces, uv=uv, uv_faces=faces, texture=stripes)


@pytest.fixture(scope="module")
def surfaces():
    plain = ball(20.0, np.array([25.0, 10, 40]))
    colours = np.tile([0.8, 0.3, 0.2], (len(plain.vertices), 1))
    return [ball(50.0, np.zeros(3)), Surface(plain.vertices, plain.faces, colours=colours)]


def psnr(a, b):
    return 10 * np.log10(255**2 / ((a.astype(float) - b) ** 2).mean())


@pytest.mark.parametrize("yaw", [0.0, 40.0])
def test_frames_are_what_render_mesh_draws(surfaces, yaw):
    camera = ScaledOrthographicCamera.look(yaw, 10.0, size=160, extent=140.0)
    renderer = FrameRenderer(surfaces, camera, 160)
    for shift in ([0.0, 0, 0], [7.3, -4.1, 0.5]):
        moved = [part.vertices + shift for part in surfaces]
        parts = [
            Surface(points, part.faces, part.colours, part.uv, part.uv_faces, part.texture)
            for part, points in zip(surfaces, moved, strict=True)
        ]
        assert psnr(renderer.frame(moved), render_mesh(parts, camera, 160)) > 36


def test_vertex_colours_and_coloured_light_are_those_of_render_mesh(surfaces):
    camera = ScaledOrthographicCamera.look(size=160, extent=140.0)
    light = studio_light() * [1.0, 0.7, 0.4]
    textured = surfaces[0]
    painted = Surface(surfaces[1].vertices, surfaces[1].faces, colours=0.5 + 0.4 * np.cos(surfaces[1].vertices / 9))
    frame = FrameRenderer([textured, painted], camera, 160, light=light).frame([textured.vertices, painted.vertices])
    assert psnr(frame, render_mesh([textured, painted], camera, 160, light=light)) > 36


def test_outlines_are_as_smooth_as_those_of_render_mesh(surfaces):
    """At the edge of the picture's ball, where a pixel is covered in part, the same mixtures to a few steps."""
    camera = ScaledOrthographicCamera.look(size=160, extent=140.0)
    frame, whole = (
        FrameRenderer(surfaces, camera, 160).frame([p.vertices for p in surfaces]),
        render_mesh(surfaces, camera, 160),
    )
    jagged = render_mesh(surfaces, camera, 160, supersample=1)
    ground = whole[0, 0].astype(int)
    partly = np.abs(whole.astype(int) - jagged).max(axis=2) > 40
    assert partly.sum() > 50 and (np.abs(jagged[partly] - ground).max(axis=1) > 0).any()
    assert np.abs(frame[partly].astype(int) - whole[partly]).max() < 12


def test_a_frame_does_not_depend_on_those_before(surfaces):
    camera = ScaledOrthographicCamera.look(size=64, extent=140.0)
    renderer, rest = FrameRenderer(surfaces, camera, 64), [part.vertices for part in surfaces]
    first = renderer.frame(rest)
    renderer.frame([points + 9 for points in rest])
    np.testing.assert_array_equal(renderer.frame(rest), first)
    np.testing.assert_array_equal(FrameRenderer(surfaces, camera, 64).frame(rest), first)


def test_what_leaves_the_picture_is_not_drawn(surfaces):
    camera = ScaledOrthographicCamera.look(size=64, extent=140.0)
    renderer = FrameRenderer(surfaces, camera, 64, background=(0.2, 0.4, 0.6))
    empty = renderer.frame([part.vertices + [1000, 0, 0] for part in surfaces])
    assert (empty == np.array([51, 102, 153])).all()
    half = renderer.frame([part.vertices + [-70, 0, 0] for part in surfaces])
    assert (half[:, -8:] == [51, 102, 153]).all() and (half[:, 0] != [51, 102, 153]).any()


def test_surfaces_may_be_seen_from_inside():
    camera = ScaledOrthographicCamera.look(size=64, extent=140.0)
    turned = Surface(np.array([[-50.0, -50, 0], [50, -50, 0], [0, 50, 0]]), np.array([[0, 2, 1]]))
    seen = [FrameRenderer([turned], camera, 64, cull_back=cull).frame([turned.vertices]) for cull in (False, True)]
    assert np.ptp(seen[0]) > 20 and np.ptp(seen[1][:, :, 0]) == 0


def test_other_meshes_are_refused(surfaces):
    camera = ScaledOrthographicCamera.look(size=64, extent=140.0)
    with pytest.raises(ValueError, match=r"vertices: expected \[625, 625\] of the surfaces, got \[625\]"):
        FrameRenderer(surfaces, camera, 64).frame([surfaces[0].vertices])
    with pytest.raises(ValueError, match="size: expected a positive number of px, got 0"):
        FrameRenderer(surfaces, camera, 0)
    with pytest.raises(ValueError, match="vertices: expected finite numbers, got others"):
        FrameRenderer(surfaces, camera, 64).frame([part.vertices * np.nan for part in surfaces])
