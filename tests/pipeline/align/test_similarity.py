import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.geometry.rotations.similarity import similarity


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_recovers_a_similarity_exactly(rng, scale):
    points = rng.normal(size=(20, 3))
    R = Rotation.from_rotvec([0.3, -2.0, 0.5]).as_matrix()
    found = similarity(points, scale * points @ R.T + [1, 2, 3])
    assert found[0] == pytest.approx(scale, rel=1e-12)
    np.testing.assert_allclose(found[1], R, atol=1e-12)
    np.testing.assert_allclose(found[2], [1, 2, 3], atol=1e-11 * max(1, scale))


def test_is_a_rotation_even_for_mirrored_points(rng):
    points = rng.normal(size=(20, 3))
    _, R, _ = similarity(points, points * [-1, 1, 1])
    assert np.linalg.det(R) == pytest.approx(1, abs=1e-12)


def test_no_other_similarity_is_closer(rng):
    source, target = rng.normal(size=(2, 15, 3))
    s, R, t = similarity(source, target)
    best = ((s * source @ R.T + t - target) ** 2).sum()
    for _ in range(50):
        nudge = Rotation.from_rotvec(rng.normal(size=3) * 0.01).as_matrix()
        other = (1 + rng.normal() * 0.01) * s * source @ (nudge @ R).T + t + rng.normal(size=3) * 0.01
        assert ((other - target) ** 2).sum() >= best
