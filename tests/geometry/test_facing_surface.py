"""Partners on the side that looks where the seeker looks."""

import numpy as np
import pytest

from toongeo.geometry.facing_surface import FacingSurface, barycentric

# Two sheets over the same right triangle: one looks up, 0.2 above it one looks down.
SHEET = np.array([[0.0, 0, 0], [3, 0, 0], [0, 3, 0]])
V = np.vstack([SHEET, SHEET + [0, 0, 0.2]])
UP, DOWN = [0, 1, 2], [3, 5, 4]
PLACE = np.array([[0.9, 0.6]])
BARY = [0.5, 0.3, 0.2]


@pytest.mark.parametrize("upper_first", [False, True])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_the_nearer_sheet_is_passed_over_if_it_looks_away(upper_first, way):
    """Whatever the number of the triangle, the first one too."""
    F = np.array([DOWN, UP] if upper_first else [UP, DOWN])
    surface = FacingSurface(V, F)
    seeker = np.column_stack([PLACE, [0.15 if way > 0 else 0.05]])  # nearer to the other sheet
    triangles, bary, cosines = surface.closest(seeker, np.array([[0, 0, way]]))
    assert F[triangles[0]].tolist() == (UP if way > 0 else DOWN)
    np.testing.assert_allclose(cosines, 1)
    np.testing.assert_allclose(surface.points(triangles, bary)[0], [*PLACE[0], 0 if way > 0 else 0.2], atol=1e-12)


def test_where_none_looks_the_same_way_the_nearest_of_all_counts():
    surface = FacingSurface(SHEET, np.array([UP]))
    triangles, bary, cosines = surface.closest(np.array([[0.9, 0.6, 0.4]]), np.array([[0.0, 0, -1]]))
    assert triangles.tolist() == [0]
    np.testing.assert_allclose(bary, [BARY], atol=1e-12)
    np.testing.assert_allclose(cosines, -1)


def test_the_border_is_the_edges_that_one_triangle_has():
    F = np.array([[0, 1, 2], [1, 3, 2]])
    square = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    surface = FacingSurface(square, F)
    bary = np.array([[0, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 0.5, 0], [0.2, 0.3, 0.5]])
    np.testing.assert_array_equal(surface.at_border(np.zeros(4, int), bary), [False, True, True, False])


def test_closest_points_of_a_triangle(rng):
    triangle = rng.normal(size=(1, 3, 3))
    points = rng.normal(size=(500, 3)) * 2
    bary = barycentric(points, np.repeat(triangle, 500, axis=0))
    assert (bary >= 0).all() and np.allclose(bary.sum(1), 1)
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, 201)] * 2), -1).reshape(-1, 2)
    grid = grid[grid.sum(1) <= 1]
    samples = np.column_stack([1 - grid.sum(1), grid]) @ triangle[0]
    distance = np.linalg.norm(points - bary @ triangle[0], axis=1)
    sampled = np.linalg.norm(points[:, None] - samples, axis=2).min(1)
    assert (distance <= sampled + 1e-12).all() and np.abs(distance - sampled).max() < 0.05


def test_partners_face_the_same_way(bumpy):
    V, F = bumpy
    surface = FacingSurface(V, F)
    triangles, bary, cosines = surface.closest(V, surface.normals)
    np.testing.assert_allclose(surface.points(triangles, bary), V, atol=1e-12)
    assert (cosines > 0.99).all()
