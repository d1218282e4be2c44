"""Rotation vectors against scipy and finite differences, across the switch to the Taylor polynomial."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.pipeline.fit.rotation import left_jacobian, rotation_matrix

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
