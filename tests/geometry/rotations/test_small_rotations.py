"""Rotation vectors, their derivative, and the polar decomposition."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.geometry.rotations.polar_decomposition import polar_decomposition
from toongeo.geometry.rotations.rotation_exp import cross_matrix, right_jacobian, rotation_exp
from toongeo.geometry.rotations.rotation_log import rotation_log


def along_last(matrices):
    return np.ascontiguousarray(np.moveaxis(matrices, 0, -1))


@pytest.mark.parametrize("size", [0.0, 1e-12, 1e-6, 9e-3, 1.1e-2, 1.0, 3.0, np.pi - 1e-3, np.pi - 1e-7])
def test_log_inverts_exp(rng, size):
    w = rng.normal(size=(3, 50))
    w *= size / np.linalg.norm(w, axis=0)
    R = rotation_exp(w)
    np.testing.assert_allclose(R, along_last(Rotation.from_rotvec(w.T).as_matrix()), atol=1e-14)
    np.testing.assert_allclose(rotation_log(R), w, atol=1e-8)


def test_half_turns_keep_their_axis(rng):
    axis = rng.normal(size=(3, 20))
    axis /= np.linalg.norm(axis, axis=0)
    w = rotation_log(rotation_exp(np.pi * axis))
    np.testing.assert_allclose(np.abs((w * axis).sum(0)), np.pi, atol=1e-6)


@pytest.mark.parametrize("size", [1e-9, 5e-3, 0.5, 3.0])
def test_right_jacobian_is_the_derivative(rng, size):
    """The remainder of first order falls with the square of the step."""
    w, d = rng.normal(size=(2, 3, 10))
    w *= size
    moved = cross_matrix((right_jacobian(w) * d).sum(1))
    first = np.einsum("abn,bcn->acn", rotation_exp(w), moved)
    steps = np.array([1e-2, 1e-3])
    left = [np.abs(rotation_exp(w + h * d) - rotation_exp(w) - h * first).max() for h in steps]
    assert np.log10(left[0] / left[1]) > 1.9


def test_polar_of_positive_determinants_is_that_of_the_svd(rng):
    T = rng.normal(size=(20000, 3, 3)) * np.exp(rng.normal(size=(20000, 1, 1)))
    T = T[np.linalg.det(T) > 1e-4 * np.linalg.norm(T, axis=(1, 2)) ** 3]
    before = T.copy()
    R, S = polar_decomposition(along_last(T))
    U, s, Vt = np.linalg.svd(T)
    np.testing.assert_allclose(R, along_last(U @ Vt), atol=1e-9)
    np.testing.assert_allclose(S, along_last(np.swapaxes(Vt, 1, 2) @ (s[:, :, None] * Vt)), rtol=1e-7, atol=1e-7)
    np.testing.assert_array_equal(T, before)


def test_polar_does_not_write_to_its_argument(rng):
    T = rng.normal(size=(3, 3, 100))
    before = T.copy()
    polar_decomposition(T)
    np.testing.assert_array_equal(T, before)


def test_polar_of_reflections_and_of_singular_matrices(rng):
    T = rng.normal(size=(500, 3, 3))
    T[np.linalg.det(T) > 0, 0] *= -1
    T[::5, 2] = 0.0
    T[0] = 0.0
    R, S = polar_decomposition(along_last(T))
    np.testing.assert_allclose(np.einsum("ban,bcn->acn", R, R), np.repeat(np.eye(3)[:, :, None], 500, 2), atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(np.moveaxis(R, -1, 0)), 1, atol=1e-9)
    np.testing.assert_allclose(np.einsum("abn,bcn->acn", R, S), along_last(T), atol=1e-9)


def test_polar_turns_no_tangent_plane_over():
    """A ring whose normal component grows and changes sign keeps its rotation where the normal is told."""
    turn = rotation_exp(np.array([[0.3], [-0.2], [0.5]]))
    T = np.einsum("abn,bcn->acn", turn, np.diag([1.0, 1.2, -4.0])[:, :, None])
    R, S = polar_decomposition(T, np.array([[0.0], [0.0], [-1.0]]))
    np.testing.assert_allclose(R, turn, atol=1e-12)
    np.testing.assert_allclose(S[:, :, 0], np.diag([1.0, 1.2, -4.0]), atol=1e-12)
