"""The rotation of least squares, also where a reflection would come nearer."""

import numpy as np
import pytest

from toongeo.geometry.rotations.rigid_rotation import rigid_rotation

# The axes through the centre are the principal ones, with moments 18 > 8 > 2.
CROSS = np.array([[3.0, 0, 0], [-3, 0, 0], [0, 2, 0], [0, -2, 0], [0, 0, 1], [0, 0, -1]])


def test_a_rotation_is_found_whatever_the_shift(rotation, rng):
    P = rng.normal(size=(20, 3))
    np.testing.assert_allclose(rigid_rotation(P, P @ rotation.T + [4, -5, 6]), rotation, atol=1e-12)


@pytest.mark.parametrize("axis", range(3))
def test_of_a_mirrored_body_the_nearest_rotation_is_known(axis):
    """Whichever axis is mirrored, no rotation is nearer than the one that pays with the axis of the least moment."""
    mirror = np.ones(3)
    mirror[axis] = -1
    payed = np.array([1.0, 1, -1])
    np.testing.assert_allclose(rigid_rotation(CROSS, CROSS * mirror), np.diag(mirror * payed), atol=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_flat_bodies_are_turned_not_mirrored(rotation, seed):
    """A plane leaves the sign of the third axis open; only one is a rotation."""
    P = np.random.default_rng(seed).normal(size=(9, 3)) * [1, 1, 0]
    np.testing.assert_allclose(rigid_rotation(P, P @ rotation.T), rotation, atol=1e-12)
