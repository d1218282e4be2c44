"""Texture coordinates of surfaces that have none."""

import numpy as np
import pytest

from toongeo.model import MorphableModel
from toongeo.model.supply.flattened import flattened


def mask(model, name="face"):
    front = model.faces[model.region(name)[model.faces].all(1)]
    used, faces = np.unique(front, return_inverse=True)
    return model.mean[used], faces.reshape(-1, 3)


def signed(uv, F):
    a, b = uv[F[:, 1]] - uv[F[:, 0]], uv[F[:, 2]] - uv[F[:, 0]]
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def test_no_triangle_is_turned_over(model):
    V, F = mask(model)
    areas = signed(flattened(V, F), F)
    main = np.abs(areas) > 0
    assert (areas[main] > 0).all()  # counter-clockwise in the picture as on the face


def test_the_subjects_left_is_on_the_right_and_up_is_up(model):
    V, F = mask(model)
    uv = flattened(V, F)
    right, left = uv[V[:, 0] < -30].mean(0), uv[V[:, 0] > 30].mean(0)
    assert left[0] > right[0] + 0.2
    assert uv[V[:, 1] > 30][:, 1].mean() > uv[V[:, 1] < -60][:, 1].mean() + 0.2
    assert uv.min() >= 0 and uv.max() <= 1


def test_other_parts_lie_in_the_strip_below(model):
    V, F = mask(model)
    eye = model.eyes[0]
    both = np.vstack([V, eye.vertices * 10 + [0, 0, 500]])
    uv = flattened(both, np.vstack([F, eye.faces + len(V)]))
    assert uv[len(V) :, 1].max() <= 0.12 < uv[: len(V), 1].min() + 0.01
    assert not np.allclose(uv[len(V) :].std(0), 0)


def test_a_closed_surface_keeps_its_globe(model):
    V = np.vstack([np.eye(3), -np.eye(3)])
    F = np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])
    assert flattened(V, F) is None
    ball = MorphableModel.from_arrays(100 * V, F)
    assert ball.with_uv() is ball
    assert model.with_uv() is model


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_the_size_of_a_face_changes_nothing(model, scale):
    V, F = mask(model, "mouth")
    np.testing.assert_allclose(flattened(scale * V, F), flattened(V, F), atol=1e-6)
