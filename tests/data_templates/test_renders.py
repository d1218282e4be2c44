"""The renderer of training pictures."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "data_templates" / "build"))

from renders.random_head import KINDS
from renders.render_face import STYLES, Part, drawn, render_face
from renders.scene import random_scene
from renders.warp import random_warp, warped


def test_the_same_generator_gives_the_same_bytes():
    one, other = (render_face(np.random.default_rng(5), size=128) for _ in range(2))
    assert one.picture.tobytes() == other.picture.tobytes() and one.parts.tobytes() == other.parts.tobytes()
    np.testing.assert_array_equal(one.landmarks, other.landmarks)
    assert render_face(np.random.default_rng(6), size=128).picture.tobytes() != one.picture.tobytes()


@pytest.mark.parametrize("style", STYLES)
def test_every_style_draws_a_picture(style):
    render = render_face(np.random.default_rng(STYLES.index(style)), "cartoon", style, 96)
    assert render.picture.shape == (96, 96, 3) and render.picture.dtype == np.uint8 and render.style == style
    assert render.picture.std() > 8
    assert (style == "grey") <= bool((np.ptp(render.picture.astype(int), axis=2) < 60).all())


@pytest.mark.parametrize("kind", KINDS)
def test_landmarks_lie_where_the_parts_are(kind):
    rng = np.random.default_rng(KINDS.index(kind))
    hits = []
    for _ in range(4):
        scene = random_scene(rng, kind, size=160)
        assert abs(np.sqrt(((scene.landmarks - scene.landmarks.mean(0)) ** 2).sum(1).mean()) - 0.175 * 160) < 5
        for first in (36, 42):
            eye = scene.landmarks[first : first + 6]
            x, y = np.rint(eye.mean(0)).astype(int)
            hits.append(scene.parts[y, x] in (Part.EYE, Part.SKIN, Part.GLASSES, Part.HAIR, Part.HAND))
    assert np.mean(hits) == 1


def test_a_frontal_face_has_eyes_between_its_lids():
    rng, shares = np.random.default_rng(1), []
    for _ in range(12):
        scene = random_scene(rng, "person", size=160)
        if abs(scene.yaw) < 20:
            eye = scene.landmarks[36:42].mean(0)
            x, y = np.rint(eye).astype(int)
            shares.append((scene.parts[y - 1 : y + 2, x - 1 : x + 2] == Part.EYE).any())
    assert np.mean(shares) > 0.6  # the others squint or wear dark glasses


def test_one_scene_can_be_drawn_twice():
    rng = np.random.default_rng(2)
    scene = random_scene(rng, "person", size=96)
    before = scene.picture.copy()
    pictures = [drawn(rng, scene, style).picture for style in ("photo", "ink")]
    assert pictures[0].tobytes() != pictures[1].tobytes()
    np.testing.assert_array_equal(scene.picture, before)


def test_a_warp_moves_landmarks_with_the_picture():
    rng = np.random.default_rng(3)
    landmarks = random_scene(rng, "person", size=128).landmarks
    y, x = np.mgrid[:128, :128].astype(np.float32)
    field = random_warp(rng, landmarks, 128, 3.0, parts=True)
    moved, seen_x, seen_y = warped(field, landmarks, x, y)
    inside = ((moved > 2) & (moved < 125)).all(1)
    for source, axis in ((seen_x, 0), (seen_y, 1)):
        rows = np.rint(moved[inside]).astype(int)
        np.testing.assert_allclose(source[rows[:, 1], rows[:, 0]], landmarks[inside, axis], atol=1.7)
