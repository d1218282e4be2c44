"""Self-intersections: closed forms, brute force, a rival, invariances."""

import numpy as np
import pytest

from toongeo.geometry.mesh_checks.box_pairs import box_pairs
from toongeo.geometry.self_intersections import self_intersections

BASE = [[0.0, 0, 0], [4, 0, 0], [0, 4, 0]]


def crosses(*other):
    """Whether a triangle with these corners intersects BASE."""
    pairs = self_intersections(np.array([*BASE, *other], float), [[0, 1, 2], [3, 4, 5]])
    return pairs.tolist() == [[0, 1]]


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        ([[1, 1, -1], [1, 1, 1], [9, 9, 0]], True),  # an edge passes through
        ([[1, 1, -1], [1, 2, -1], [1, 1, 1]], True),  # both ends within
        ([[-1, 1, -1], [9, 1, -1], [1, 1, 9]], True),  # the other cuts right across
        ([[3, 3, -1], [3, 3, 1], [9, 9, 0]], False),  # passes beside
        ([[0, 0, 1], [4, 0, 1], [0, 4, 1]], False),  # parallel
        ([[1, 1, 0], [1, 1, 1], [2, 1, 1]], True),  # touches with a corner
        ([[1, 1, 1e-9], [1, 1, 1], [2, 1, 1]], False),
        ([[2, -1, -1], [2, 1, 1], [2, -1, 1]], True),  # edges cross exactly
        ([[1, 1, 0], [2, 1, 0], [1, 2, 0]], True),  # coplanar, inside
        ([[-1, -1, 0], [9, -1, 0], [-1, 9, 0]], True),  # coplanar, around
        ([[3, -1, 0], [3, 3, 0], [9, 3, 0]], True),  # coplanar, partly
        ([[4, 4, 0], [4, 0, 0], [0, 4, 0]], False),  # coplanar, a common border only
        ([[5, 5, 0], [6, 5, 0], [5, 6, 0]], False),  # coplanar, apart
        (BASE, True),  # the same place twice
        ([[1, 1, 0], [1, 1, 0], [1, 1, 0]], False),  # a point has no area
        ([[1, 1, -1], [1, 1, 1], [1, 1, 3]], True),  # a needle through it
    ],
)
def test_two_triangles(other, expected):
    assert crosses(*other) is expected
    # Whatever the order of corners and triangles, and the scale.
    V, F = np.array([*BASE, *other], float), np.array([[0, 1, 2], [3, 4, 5]])
    for faces in (F[::-1], F[:, ::-1], F[:, [1, 2, 0]], np.stack([F[0], F[1][[2, 0, 1]]])):
        assert (len(self_intersections(V, faces)) == 1) is expected
    for scale in (1e-4, 1e4):
        assert (len(self_intersections(scale * V, F)) == 1) is expected


@pytest.mark.parametrize(
    ("tips", "expected"),
    [
        ([[1, 1, 1], [1, 2, 1]], False),  # only the common corner
        ([[1, 1, -1], [2, 1, 1]], True),  # the opposite edge passes through the base
        ([[9, 1, -1], [9, 1, 1]], True),  # cuts the base's opposite edge
        ([[-1, 1, 0], [-1, 2, 0]], False),  # coplanar fan
        ([[3, 1, 0], [1, 3, 0]], True),  # coplanar and on top
        ([[-1, 1, -1], [-1, 1, 1]], False),
    ],
)
def test_with_a_common_corner(tips, expected):
    V = np.array([*BASE, *tips], float)
    for faces in ([[0, 1, 2], [0, 3, 4]], [[2, 0, 1], [4, 0, 3]], [[1, 2, 0], [3, 4, 0]]):
        assert (len(self_intersections(V, faces)) == 1) is expected


def test_neighbours_along_an_edge_are_never_reported():
    V = np.array([*BASE, [1, 1, 0.1]])
    assert self_intersections(V, [[0, 1, 2], [1, 0, 3]]).shape == (0, 2)


def test_sound_meshes_have_none(sphere, grid, bumpy, two_parts):
    for V, F in (sphere, grid, bumpy, two_parts):
        assert self_intersections(V, F).shape == (0, 2)


def edge_meets(p, q, triangle):
    """Slow reference for general position: solve p + t (q - p) = a + u (b - a) + v (c - a)."""
    a, b, c = triangle
    t, u, v = np.linalg.solve(np.stack([p - q, b - a, c - a], axis=1), p - a)
    return 0 <= t <= 1 and u >= 0 and v >= 0 and u + v <= 1


def test_brute_force_on_a_soup():
    rng = np.random.default_rng(0)
    T = rng.random((60, 1, 3)) + rng.normal(0, 0.4, (60, 3, 3))
    expected = []
    for i in range(60):
        for j in range(i + 1, 60):
            edges = [(T[i, k - 1], T[i, k], T[j]) for k in range(3)] + [(T[j, k - 1], T[j, k], T[i]) for k in range(3)]
            if any(edge_meets(*edge) for edge in edges):
                expected.append([i, j])
    result = self_intersections(T.reshape(-1, 3), np.arange(180).reshape(60, 3))
    assert len(expected) > 100
    assert result.dtype == np.int64
    np.testing.assert_array_equal(result, expected)


def test_the_same_faces_as_meshlab(bumpy):
    pymeshlab = pytest.importorskip("pymeshlab", reason="needs pymeshlab")
    V, F = bumpy
    rng = np.random.default_rng(2)
    twice = np.concatenate([V, 1.05 * V[:, [1, 2, 0]]]), np.concatenate([F, F + len(V)])
    for vertices, faces in (twice, (V + rng.normal(0, 0.1, V.shape), F)):
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertices, faces))
        meshes.compute_selection_by_self_intersections_per_face()
        expected = np.flatnonzero(meshes.current_mesh().face_selection_array())
        assert len(expected) > 50
        np.testing.assert_array_equal(np.unique(self_intersections(vertices, faces)), expected)


def test_ignores_a_rigid_motion_and_scale(bumpy, rotation):
    V, F = bumpy
    V = V + np.random.default_rng(2).normal(0, 0.1, V.shape)
    expected = self_intersections(V, F)
    for scale in (1e-4, 1.0, 1e4):
        np.testing.assert_array_equal(self_intersections(scale * (V @ rotation.T + [5, 6, 7]), F), expected)


@pytest.mark.parametrize("m", [1, 2, 3, 37, 256, 1500])
def test_box_pairs_are_all_overlaps(m, monkeypatch):
    monkeypatch.setattr("toongeo.geometry.mesh_checks.box_pairs._CHUNK", 1000)
    rng = np.random.default_rng(m)
    low = rng.random((3, m))
    high = low + rng.random((3, m)) * rng.choice([0.0, 0.05, 0.6], (1, m))
    chunks = [np.sort(np.stack(pair, axis=1), axis=1) for pair in box_pairs(low, high)]
    result = np.concatenate(chunks)
    both = (low[:, :, None] <= high[:, None]) & (low[:, None] <= high[:, :, None])
    expected = np.argwhere(np.triu(both.all(axis=0), 1))
    np.testing.assert_array_equal(result[np.lexsort(result.T[::-1])], expected)


def test_bad_mesh():
    with pytest.raises(ValueError, match="V: expected finite coordinates"):
        self_intersections(np.full((3, 3), np.nan), [[0, 1, 2]])
    with pytest.raises(ValueError, match=r"F: expected indices in 0\.\.2, got 3"):
        self_intersections(np.eye(3), [[0, 1, 3]])
