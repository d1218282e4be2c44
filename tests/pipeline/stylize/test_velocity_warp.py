"""Warps by velocity fields: closed forms, inverses, symmetry, no folds."""

import numpy as np
import pytest

from toongeo import default_model
from toongeo.pipeline.stylize.face_frame import face_frame
from toongeo.pipeline.stylize.style_rules import WarpRule, style_rules
from toongeo.pipeline.stylize.velocity_warp import velocity_warp

SHAPE = (600, 500)
MIRROR = np.r_[
    16:-1:-1, 26:16:-1, 27:31, 35:30:-1, 45:41:-1, 47, 46, 39:35:-1, 41, 40, 54:47:-1, 59:54:-1, 64:59:-1, 67:64:-1
]


def face(seed=None, size=1.6):
    """Landmarks (68, 2) of the mean face, or of a random one, turned and stretched."""
    model = default_model()
    if seed is None:
        return model.mean[model.landmarks][:, :2] * [size, -size] + [250, 300]
    rng = np.random.default_rng(seed)
    V = model.vertices(rng.normal(size=len(model.identity)), rng.uniform(0, 0.4, len(model.expression)))
    angle = rng.normal() * 0.3
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    points = V[model.landmarks][:, :2] * [size, -size] @ turn.T + [250, 300]
    return points + rng.normal(size=(68, 2)) * rng.uniform(0, 6)


def rule(scale=(1.0, 1.0), shift=(0.0, 0.0), reach=(0.6, 0.6)):
    return WarpRule((33,), scale, shift, reach, (0.0, 0.0))


def test_a_scaling_is_exact_at_its_centre():
    """There the flow is that of a linear field: exp of its matrix."""
    points = face()
    warp = velocity_warp(SHAPE, points, [rule(scale=(1.3, 0.8))])
    step = 0.5 * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
    moved = warp.points(points[33] + step @ face_frame(points).axes)
    jacobian = np.stack([moved[0] - moved[1], moved[2] - moved[3]]) @ face_frame(points).axes.T
    np.testing.assert_allclose(jacobian, np.diag([1.3, 0.8]), atol=0.02)
    np.testing.assert_allclose(warp.points(points[33]), points[33], atol=0.05)


def test_nothing_moves_beyond_the_reach_of_a_rule_or_without_strength():
    points = face()
    far = points[33] + 0.61 * face_frame(points).size * np.array([[1, 0], [0, 1], [0.6, -0.8]])
    np.testing.assert_allclose(velocity_warp(SHAPE, points, [rule(scale=(1.5, 1.5))]).points(far), far, atol=0.05)
    np.testing.assert_array_equal(velocity_warp(SHAPE, points, style_rules()["toon"], 0.0).points(points), points)


@pytest.mark.parametrize("style", sorted(style_rules()))
def test_there_and_back(style):
    points = face()
    warp = velocity_warp(SHAPE, points, style_rules()[style])
    grid = np.stack(np.meshgrid(np.linspace(0, 499, 40), np.linspace(0, 599, 40)), -1)
    np.testing.assert_allclose(warp.inverse(warp.points(grid)), grid, atol=0.1)
    np.testing.assert_allclose(warp.points(warp.inverse(grid)), grid, atol=0.1)


def test_no_random_face_folds_at_any_strength():
    """Chibi warps bend most; displacements of landmarks push as well."""
    for seed in range(12):
        rng = np.random.default_rng([5, seed])
        displacement = rng.normal(size=(68, 2)) * 25
        warp = velocity_warp(SHAPE, face(seed), style_rules()["chibi"], rng.uniform(0, 2), displacement)
        assert warp.determinants().min() > 0.01


def test_a_mirrored_face_is_warped_mirrored():
    points = face(3)
    mirrored = (points * [-1, 1] + [SHAPE[1] - 1, 0])[MIRROR]
    moved = velocity_warp(SHAPE, points, style_rules()["chibi"]).points(points)
    other = velocity_warp(SHAPE, mirrored, style_rules()["chibi"]).points(mirrored)
    np.testing.assert_allclose((other * [-1, 1] + [SHAPE[1] - 1, 0])[MIRROR], moved, atol=0.2)


def test_the_warp_of_a_resized_picture():
    points = face()
    warp = velocity_warp(SHAPE, points, style_rules()["toon"])
    np.testing.assert_allclose(
        warp.scaled(0.5).points((points + 0.5) / 2 - 0.5), (warp.points(points) + 0.5) / 2 - 0.5, atol=1e-3
    )


def test_a_picture_moves_as_its_points():
    """A dot at a corner of an eye is found where the corner goes."""
    points = face()
    warp = velocity_warp(SHAPE, points, style_rules()["toon"])
    rows, columns = np.mgrid[: SHAPE[0], : SHAPE[1]]
    for corner in (36, 45, 8):
        dot = np.exp(-((columns - points[corner, 0]) ** 2 + (rows - points[corner, 1]) ** 2) / 18).astype(np.float32)
        moved = warp.picture(dot)
        found = np.array([(moved * columns).sum(), (moved * rows).sum()]) / moved.sum()
        np.testing.assert_allclose(found, warp.points(points[corner]), atol=0.7)


def test_displacements_of_landmarks_are_followed():
    """A shift of all of them shifts the face; the ridge takes a few per cent."""
    points = face()
    warp = velocity_warp(SHAPE, points, (), 1.0, np.tile([8.0, 0.0], (68, 1)))
    np.testing.assert_allclose(warp.points(points) - points, np.tile([8.0, 0.0], (68, 1)), atol=0.8)
