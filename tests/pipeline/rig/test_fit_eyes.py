import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.pipeline.rig.fit_eyes import _inset, _rim, _robust_sphere


def test_sphere_through_exact_points_is_found(rng):
    directions = rng.normal(size=(60, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    points = np.array([1.0, 2, 3]) + 12 * directions
    centre, radius = _robust_sphere(points, np.array([1.2, 1.9, 3.1]), 12.1)
    np.testing.assert_allclose([*centre, radius], [1, 2, 3, 12], atol=0.05)


def test_the_sphere_is_robust_and_equivariant(rng):
    directions = rng.normal(size=(60, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    points = 12 * directions
    points[:4] *= 3
    centre, radius = _robust_sphere(points, np.zeros(3), 12.0)
    assert np.linalg.norm(centre) < 0.5
    R, t = Rotation.from_rotvec([0.1, 0.4, -0.8]).as_matrix(), np.array([5.0, -3, 8])
    turned, again = _robust_sphere(2 * points @ R.T + t, t, 24.0)
    np.testing.assert_allclose(turned, 2 * R @ centre + t, atol=1e-9)
    assert again == pytest.approx(2 * radius, rel=1e-12)


def test_inset_brings_the_deepest_point_to_the_surface(rng):
    points = rng.normal(size=(100, 3)) * 4
    inset = _inset(points, 10.0)
    ahead = points[points[:, 2] > 0]
    distance = np.linalg.norm(ahead + [0, 0, inset], axis=1)
    assert inset > 0
    assert distance.min() == pytest.approx(10.0, rel=1e-12)
    assert _inset(points + [0, 0, 100], 10.0) == 0


def test_no_lid_touches_the_eyeball_in_any_expression(avatar):
    model = avatar.face.model
    for side, name in enumerate(("left", "right")):
        lids = model.region(f"eyelid_upper_{name}") | model.region(f"eyelid_lower_{name}")
        lids[_rim(model, name)] = True
        for delta in (np.zeros_like(avatar.rig.deltas[0]), *avatar.rig.deltas):
            offset = (avatar.rig.neutral + delta)[lids] - avatar.eyes.centres[side]
            ahead = offset[:, 2] > 0
            assert np.linalg.norm(offset[ahead], axis=1).min() >= avatar.eyes.radii[side]


def test_gaze_turns_the_eyeball_about_its_centre(avatar):
    rest = avatar.eyes.vertices(0)
    turned = avatar.eyes.looking(0, {"eyeLookOutLeft": 1.0})
    radius = np.linalg.norm(turned - avatar.eyes.centres[0], axis=1)
    np.testing.assert_allclose(radius, avatar.eyes.radii[0], rtol=1e-9)
    assert turned[0, 0] > rest[0, 0] + 0.4 * avatar.eyes.radii[0]
