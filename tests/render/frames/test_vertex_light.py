"""Light of vertices beside normals and harmonics in double precision."""

import numpy as np

from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.model import default_model
from toongeo.render import irradiance
from toongeo.render.frames.vertex_light import VertexLight


def test_light_is_that_of_normals_and_harmonics():
    model, light = default_model(), np.random.default_rng(0).normal(size=(9, 3))
    light[0] += 2
    expected = np.maximum(irradiance(vertex_normals(model.mean, model.faces), light) / np.pi, 0)
    assert (expected == 0).any() and expected.max() > 1
    found = VertexLight(model.faces, len(model.mean), light).of(model.mean)
    assert np.quantile(np.abs(found - expected), 0.99) < 1e-4
    assert np.abs(found - expected).max() < 0.05  # slivers have no sure normal in single precision
    one = VertexLight(model.faces, len(model.mean), light[:, 1:2]).of(model.mean)
    np.testing.assert_allclose(one, found[:, 1:2], atol=1e-5)


def test_a_vertex_without_a_face_is_dark():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]])
    light = np.zeros((9, 1))
    light[2] = 1.0  # from the viewer
    found = VertexLight(np.array([[0, 1, 2]]), 4, light).of(points)
    assert found[3, 0] == 0 and (found[:3, 0] > 0.3).all()
