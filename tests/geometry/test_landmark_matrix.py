"""Rows that give landmarks of a mesh."""

import numpy as np
import pytest

from toongeo.geometry.landmark_matrix import landmark_matrix


def test_points_on_a_mesh_are_given_back(bumpy, rng):
    V, F = np.asarray(bumpy[0]), np.asarray(bumpy[1])
    weights = rng.dirichlet([1, 1, 1], 40)
    points = np.einsum("kc,kcd->kd", weights, V[F[rng.integers(0, len(F), 40)]])
    matrix, given = landmark_matrix(V, F, points, "landmarks")
    np.testing.assert_allclose(matrix @ V, points, atol=1e-12)
    assert given.all() and (np.diff(matrix.indptr) == 3).all()


def test_missing_rows_are_empty(bumpy):
    V, F = np.asarray(bumpy[0]), np.asarray(bumpy[1])
    points = V[[5, 6, 7]]
    points[1, 2] = np.nan
    matrix, given = landmark_matrix(V, F, points, "landmarks")
    assert given.tolist() == [True, False, True]
    np.testing.assert_allclose(matrix @ V, [V[5], [0, 0, 0], V[7]], atol=1e-12)
    matrix, given = landmark_matrix(V, F, np.full((4, 3), np.nan), "landmarks")
    assert matrix.shape == (4, len(V)) and matrix.nnz == 0 and not given.any()


@pytest.mark.parametrize(
    ("landmarks", "message"),
    [
        ([0, -1], r"marks: expected vertex indices in 0..\d+, got -1"),
        ([[0.0, 1, 2], [0, np.inf, 0]], "marks: expected finite coordinates or NaN, got infinity in row 1"),
        (np.zeros((0, 3)), r"marks: expected vertex indices \(k,\) or points \(k, 3\), k >= 1"),
        (np.zeros((2, 2)), r"marks: .*got float64 \(2, 2\)"),
        (np.zeros((2, 3), bool), r"marks: .*got bool \(2, 3\)"),
    ],
)
def test_what_are_no_landmarks(bumpy, landmarks, message):
    with pytest.raises(ValueError, match=message):
        landmark_matrix(np.asarray(bumpy[0]), np.asarray(bumpy[1]), landmarks, "marks")
