"""Vertex normals: closed forms, equivariance, and no NaN."""

import numpy as np
import pytest

from toongeo.geometry.operators.vertex_normals import vertex_normals


def test_flat_grid_points_up(grid):
    np.testing.assert_array_equal(vertex_normals(*grid), np.tile([0.0, 0, 1], (63, 1)))


def test_sphere_normals_are_radial(sphere):
    V, F = sphere
    assert np.einsum("ij,ij->i", vertex_normals(V, F), V).min() > 0.995


def test_regular_tetrahedron_is_exact():
    V = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    F = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
    np.testing.assert_allclose(vertex_normals(V, F), V / np.sqrt(3), atol=1e-15)


def test_brute_force_sum_of_cross_products(bumpy):
    V, F = bumpy
    expected = np.zeros_like(V)
    for triangle in F:
        a, b, c = V[triangle]
        expected[triangle] += np.cross(b - a, c - a)
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    np.testing.assert_allclose(vertex_normals(V, F), expected, atol=1e-13)


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_rotates_with_the_mesh_and_ignores_scale(bumpy, rotation, scale):
    V, F = bumpy
    expected = vertex_normals(V, F) @ rotation.T
    np.testing.assert_allclose(vertex_normals(scale * V @ rotation.T + 5 * scale, F), expected, atol=1e-10)


def test_lonely_and_degenerate_vertices_get_zero():
    V = [[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [7, 7, 7]]
    np.testing.assert_array_equal(vertex_normals(V, [[0, 1, 2]]), np.zeros((4, 3)))


def test_vertices_whose_triangles_cancel_get_zero(grid):
    V, F = grid
    both = np.vstack([F, F[:, ::-1]])
    np.testing.assert_array_equal(vertex_normals(V, both), np.zeros_like(V))


def test_bad_mesh():
    with pytest.raises(ValueError, match=r"F: expected indices in 0\.\.1"):
        vertex_normals([[0.0, 0, 0], [1, 0, 0]], [[0, 1, 2]])
