"""Rotation vectors against scipy and finite differences, across the switch to the Taylor polynomial."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.geometry.rotations.rotation_vectors import left_jacobian, rotated, rotation_matrix, turn_of

ANGLES = [0.0, 1e-8, 0.999e-3, 1.001e-3, 0.3, 1.5, 3.0]


@pytest.mark.parametrize("angle", ANGLES)
def test_exponential_map_is_scipys(angle):
    w = angle * np.array([2, -1, 2]) / 3
    np.testing.assert_allclose(rotation_matrix(w), Rotation.from_rotvec(w).as_matrix(), atol=1e-14)


@pytest.mark.parametrize("angle", ANGLES)
def test_left_jacobian_turns_a_change_of_the_vector_into_a_rotation(angle):
    w = angle * np.array([2, -1, 2]) / 3
    h = 1e-6
    for k in range(3):
        dw = h * np.eye(3)[k]
        relative = Rotation.from_matrix(rotation_matrix(w + dw) @ rotation_matrix(w - dw).T)
        np.testing.assert_allclose(left_jacobian(w)[:, k], relative.as_rotvec() / (2 * h), atol=1e-9)


@pytest.mark.parametrize("w", [[0.3, -1.2, 0.7], [1e-5, 2e-5, -1e-5], [0.0, 0.0, 0.0]])
def test_one_vector_without_the_matrices(w):
    w, v = np.array(w), np.array([0.4, -2.0, 1.1])
    np.testing.assert_allclose(rotated(w, v), rotation_matrix(w) @ v, atol=1e-14)
    np.testing.assert_allclose(turn_of(w, tuple(v)), left_jacobian(w).T @ v, atol=1e-14)
