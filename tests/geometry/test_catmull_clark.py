"""Catmull-Clark: partition of unity, closed forms, the boundary as a B-spline, linear precision."""

import numpy as np
import pytest

from toongeo.geometry.catmull_clark import catmull_clark

CUBE = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
CUBE_V = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1.0]]
)


def grid(nx, ny):
    index = np.arange((nx + 1) * (ny + 1)).reshape(ny + 1, nx + 1)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1).reshape(-1, 4)
    y, x = np.mgrid[: ny + 1, : nx + 1]
    return np.stack([x.ravel(), y.ravel()], axis=1).astype(float), quads


@pytest.mark.parametrize(("quads", "n"), [(CUBE, 8), (grid(4, 3)[1], 20), (np.array([[5, 2, 7, 1]]), 9)])
def test_rows_sum_to_one_and_counts_agree(quads, n):
    S, quads1 = catmull_clark(quads, n)
    sides = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    assert S.shape == (n + len(np.unique(sides, axis=0)) + len(quads), n)
    assert quads1.shape == (4 * len(quads), 4)
    np.testing.assert_allclose(np.asarray(S.sum(axis=1)).ravel(), 1, atol=1e-15)
    assert S.data.min() > 0


def test_cube_has_the_known_vertices():
    S, _ = catmull_clark(CUBE, 8)
    X = S @ CUBE_V
    # Corner: F = 1/3 and R = 2/3 of it, so (1/3 + 4/3 + 0) / 3 = 5/9. Edge: (1 + 1/2) / 2. Face: 1.
    np.testing.assert_allclose(X[:8], CUBE_V * 5 / 9, atol=1e-15)
    edge = X[8:20]
    np.testing.assert_allclose(np.sort(np.abs(edge), axis=1), np.tile([0, 0.75, 0.75], (12, 1)), atol=1e-15)
    np.testing.assert_allclose(np.abs(X[20:]).sum(axis=1), 1, atol=1e-15)
    np.testing.assert_allclose(X[20:], CUBE_V[CUBE].mean(axis=1), atol=1e-15)


def test_edge_points_come_sorted_and_children_keep_corner_and_winding():
    S, quads1 = catmull_clark(CUBE, 8)
    sides = np.stack([CUBE, np.roll(CUBE, -1, axis=1)], axis=2).reshape(-1, 2)
    edges = np.unique(np.sort(sides, axis=1), axis=0)
    number = {tuple(edge): 8 + k for k, edge in enumerate(edges)}
    for k, quad in enumerate(CUBE):
        for c in range(4):
            following = number[tuple(sorted((quad[c], quad[(c + 1) % 4])))]
            previous = number[tuple(sorted((quad[c], quad[c - 1])))]
            np.testing.assert_array_equal(quads1[4 * k + c], [quad[c], following, 20 + k, previous])
    X = S @ CUBE_V
    a, b, c, d = (X[quads1[:, k]] for k in range(4))
    outward = np.einsum("ij,ij->i", np.cross(c - a, d - b), a + b + c + d)
    assert (outward > 0).all()


def test_boundary_is_a_cubic_b_spline():
    V, quads = grid(5, 4)
    rng = np.random.default_rng(0)
    V = V + rng.normal(0, 0.2, V.shape)
    S, _ = catmull_clark(quads, len(V))
    X = S @ V
    rim = np.r_[0:6, 11, 17, 23, 29, 28:23:-1, 18, 12, 6]  # once around, counter-clockwise
    P = V[rim]
    np.testing.assert_allclose(X[rim], (np.roll(P, 1, 0) + 6 * P + np.roll(P, -1, 0)) / 8, atol=1e-14)
    midpoints = (P + np.roll(P, -1, 0)) / 2
    distance = np.linalg.norm(X[len(V) : -len(quads), None] - midpoints, axis=2).min(axis=0)
    assert distance.max() < 1e-14


def test_linear_precision_on_a_regular_grid():
    V, quads = grid(6, 5)
    S, quads1 = catmull_clark(quads, len(V))
    X = S @ V
    corners = [0, 6, 35, 41]
    keep = np.setdiff1d(np.arange(len(X)), corners)  # a corner is rounded: its own curve bends there
    expected = X.copy()
    expected[: len(V)] = V
    np.testing.assert_allclose(X[keep], expected[keep], atol=1e-14)
    cells = X[quads1].mean(axis=1)
    inner = ~np.isin(quads1, corners).any(axis=1)
    np.testing.assert_allclose(np.mod(cells[inner], 0.5), 0.25, atol=1e-13)


def test_affine_maps_commute_with_subdivision():
    V, quads = grid(3, 3)
    A, t = np.array([[1.2, -0.3], [0.7, 0.4]]), np.array([5.0, -2])
    S, _ = catmull_clark(quads, len(V))
    np.testing.assert_allclose(S @ (V @ A.T + t), (S @ V) @ A.T + t, atol=1e-13)


def test_touching_fans_and_lonely_vertices_stay():
    V = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [2, 1], [2, 2], [1, 2], [9, 9]], float)
    S, _ = catmull_clark([[0, 1, 2, 3], [2, 4, 5, 6]], 8)
    X = S @ V
    np.testing.assert_array_equal(X[[2, 7]], V[[2, 7]])


@pytest.mark.parametrize(
    ("quads", "n", "message"),
    [
        (np.zeros((0, 4), int), 4, r"quads: expected an integer array of shape \(q, 4\)"),
        ([[0, 1, 2]], 3, r"quads: expected an integer array of shape \(q, 4\)"),
        ([[0.0, 1, 2, 3]], 4, "quads: expected an integer array"),
        ([[0, 1, 2, 4]], 4, r"quads: expected indices in 0\.\.3, got 0\.\.4"),
        ([[-1, 1, 2, 3]], 4, r"quads: expected indices in 0\.\.3, got -1"),
        ([[0, 1, 2, 3], [4, 5, 5, 0]], 6, "quads: expected four different corners, got a repeat in quad 1"),
        ([[0, 1, 2, 3], [1, 0, 4, 5], [0, 1, 6, 7]], 8, r"at most two quads an edge, got 3 at edge \(0, 1\)"),
    ],
)
def test_bad_input_is_named(quads, n, message):
    with pytest.raises(ValueError, match=message):
        catmull_clark(quads, n)
