"""Seams are sewn where a file had to cut, and nowhere else."""

import numpy as np
import pytest

from toongeo.geometry.border_twins import border_twins


def as_one(V, F):
    """The triangles (m, 3, 3), and how many vertices they have after welding."""
    twin = border_twins(V, F)
    np.testing.assert_array_equal(V[twin], V)
    np.testing.assert_array_equal(twin[twin], twin)
    assert (twin <= np.arange(len(V))).all()
    return twin[F]


def test_separate_triangles_become_the_surface_they_were(bumpy):
    V, F = bumpy
    soup, corners = V[F].reshape(-1, 3), np.arange(F.size).reshape(-1, 3)
    welded = as_one(soup, corners)
    names, welded = np.unique(welded, return_inverse=True)
    welded = welded.reshape(-1, 3)
    assert len(names) == len(V)
    # The same surface with its vertices in another order.
    _, first = np.unique(F, return_index=True)
    np.testing.assert_array_equal(welded.ravel()[first][F], welded)


def test_a_seam_is_sewn_and_touching_insides_are_not(sphere):
    V, F = sphere
    np.testing.assert_array_equal(as_one(V, F), F)
    # A second sphere in the same place: closed surfaces have no border.
    both = np.vstack([V, V]), np.vstack([F, F + len(V)])
    np.testing.assert_array_equal(as_one(*both), both[1])
    # Cut the sphere in two halves, each with its own vertices.
    upper = V[F].mean(1)[:, 2] > 0
    halves = np.where(upper[:, None], F + len(V), F)
    np.testing.assert_array_equal(as_one(both[0], halves) % len(V), F)
    inside = np.setdiff1d(F[upper], F[~upper])
    assert np.isin(inside + len(V), as_one(both[0], halves)).all()  # what is not at the cut keeps its number


def test_places_are_compared_exactly_and_zero_has_no_sign():
    F = np.array([[0, 1, 2], [3, 4, 5]])
    V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [-0.0, 0, -0.0], [1, 1, 0], [0, 1 + 1e-15, 0]])
    np.testing.assert_array_equal(border_twins(V, F), [0, 1, 2, 0, 4, 5])


@pytest.mark.parametrize("extra", [1, 3])
def test_vertices_in_no_triangle_are_left_alone(extra):
    V = np.zeros((3 + extra, 3))
    V[:3] = np.eye(3)
    V[3:] = V[0]
    np.testing.assert_array_equal(border_twins(V, np.array([[0, 1, 2]])), np.arange(3 + extra))
