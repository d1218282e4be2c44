"""Scenes to write."""

import numpy as np
import pytest

from toongeo.io import Scene, SceneAnimation, SceneMesh


def grid(size, rng):
    """Bumpy (size x size) sheet of two uv islands, in mm."""
    x, y = np.meshgrid(np.arange(size), np.arange(size))
    vertices = np.stack([x.ravel() * 10, y.ravel() * 10, 3 * rng.standard_normal(size * size)], axis=1)
    i = (x[:-1, :-1] + size * y[:-1, :-1]).ravel()
    quads = np.stack([i, i + 1, i + 1 + size, i + size], axis=1)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    uv = vertices[:, :2] / (20 * size)
    # The upper half has its own island: the vertices on the seam have two uv.
    upper = (vertices[faces].mean(axis=1)[:, 1] > 10 * (size // 2))[:, None]
    return (
        vertices,
        faces,
        np.concatenate([uv, uv + np.array([0.5, 0])]),
        np.where(upper, faces + len(uv), faces),
    )


@pytest.fixture
def scene():
    """A head of 3 targets (one moves nothing, one everything), and two eyes that turn; one texture."""
    rng = np.random.default_rng(0)
    vertices, faces, uv, uv_faces = grid(9, rng)
    texture = rng.integers(0, 256, (16, 16, 3), dtype=np.uint8)
    targets = np.zeros((3, len(vertices), 3))
    targets[0, 3:7] = rng.standard_normal((4, 3))
    targets[2] = rng.standard_normal((len(vertices), 3))
    names = ("jawOpen", "nothing", '"><script>alert(1)</script> 顔 \\')
    head = SceneMesh("head", vertices, faces, uv, uv_faces, texture=texture, targets=targets, target_names=names)
    eyes = []
    for side, x in (("eye_left", 30.0), ("eye_right", -30.0)):
        v, f, *_ = grid(4, rng)
        look = {"targets": rng.standard_normal((1, len(v), 3)), "target_names": ("eyeLookUp",)}
        eyes.append(
            SceneMesh(side, v + np.array([x, 0, 5]), f, pivot=np.array([x, 1.25, 5]), color=(1, 0.5, 0), **look)
        )
    plain = SceneMesh("teeth", vertices[:, [1, 2, 0]], faces, uv, uv_faces, texture=texture.copy(), roughness=0.2)
    times = np.linspace(0, 2, 5)
    weights = {"head": rng.uniform(0, 1, (5, 3)), "eye_left": rng.uniform(0, 1, (5, 1))}
    angle = 0.3 * np.sin(times)
    turn = np.stack([0 * angle, np.sin(angle / 2), 0 * angle, np.cos(angle / 2)], axis=1)
    animation = SceneAnimation(times, weights, {"eye_left": turn, "eye_right": turn})
    return Scene((head, *eyes, plain), animation)
