import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.model.anatomy.gaze import TURN
from toongeo.model.anatomy.lid_rings import lid_rings, opening_height
from toongeo.pipeline import fit_eyes
from toongeo.pipeline.rig.eyes.fit_eyes import LEAST, MOST, OFF, WANDER, _robust_sphere, _sphere, _turn

AXES = np.array([[0.0, 0.0, 1.0]])


def on_sphere(rng, centre, radius, angle=np.pi):
    """60 points off a sphere by ``OFF``, at most an angle from its front."""
    height = rng.uniform(np.cos(angle), 1, 60)
    around = rng.uniform(0, 2 * np.pi, 60)
    beside = np.sqrt(1 - height**2)
    directions = np.column_stack([beside * np.cos(around), beside * np.sin(around), height])
    return centre + (1 + OFF) * radius * directions


def test_sphere_through_exact_points_is_found(rng):
    points = on_sphere(rng, np.array([1.0, 2, 3]), 12.0)
    centre, radius = _robust_sphere(points, np.array([1.2, 1.9, 3.1]), 12.1)
    np.testing.assert_allclose([*centre, radius], [1, 2, 3, 12], atol=0.05)


def test_the_sphere_is_robust_and_equivariant(rng):
    points = on_sphere(rng, np.zeros(3), 12.0)
    points[:4] *= 3
    centre, radius = _robust_sphere(points, np.zeros(3), 12.0)
    assert np.linalg.norm(centre) < 0.5
    # The prior is isotropic across the gaze, so turns about it and scales are followed.
    R, t = Rotation.from_rotvec([0, 0, 0.7]).as_matrix(), np.array([5.0, -3, 8])
    turned, again = _robust_sphere(2 * points @ R.T + t, t, 24.0)
    np.testing.assert_allclose(turned, 2 * R @ centre + t, atol=1e-9)
    assert again == pytest.approx(2 * radius, rel=1e-12)


def test_the_eyeball_makes_room_for_skin(rng):
    points = on_sphere(rng, np.zeros(3), 12.0, angle=0.8)
    free, wide = _sphere(points, np.full((1, 3), 1e3), AXES)
    wall = np.column_stack([np.full(40, free[0] + 9.0), rng.uniform(-5, 5, (40, 2))])
    centre, radius = _sphere(points, wall, AXES)

    def through(middle, size):
        return (1 - np.linalg.norm(wall - middle, axis=1) / size).max()

    assert through(centre, radius) < 0.5 * through(free, wide)
    assert centre[0] < free[0]


@pytest.mark.parametrize("name", ["manga_girl", "astronaut", "beethoven"])
def test_eyeballs_are_as_large_as_the_openings_ask_for(aligned, transferred, name):
    face = aligned(name)
    eyes = fit_eyes(face, transferred(name))
    for side, centre, radius in zip(("left", "right"), eyes.centres, eyes.radii, strict=True):
        rim = face.vertices[lid_rings(face.model, side).vertices]
        width = np.linalg.norm(rim[:, None] - rim, axis=2).max()
        assert LEAST * width <= radius * (1 + 1e-12) and radius <= MOST * width * (1 + 1e-12)
        assert np.linalg.norm((rim - centre)[:, :2], axis=1).max() < radius


def test_gaze_turns_the_eyeball_about_its_centre(avatar):
    rest = avatar.eyes.vertices(0)
    turned = avatar.eyes.looking(0, {"eyeLookOutLeft": 1.0})
    radius = np.linalg.norm(turned - avatar.eyes.centres[0], axis=1)
    np.testing.assert_allclose(radius, avatar.eyes.radii[0], rtol=1e-6)  # the unit sphere is stored in float32
    assert turned[0, 0] > rest[0, 0] + 0.4 * avatar.eyes.radii[0]


def arch(width, height):
    """An edge of a lid (9, 3) between the corners of an eye."""
    x = np.linspace(-1, 1, 9)
    return np.column_stack([width / 2 * x, height * (1 - x**2), np.zeros(9)])


def test_eyes_turn_as_a_persons_where_the_opening_is_wide():
    np.testing.assert_array_equal(_turn(arch(40, 20), arch(40, -20), 14.0), TURN)


def test_in_a_small_opening_the_middle_of_the_iris_stays_in_it():
    upper, lower = arch(12, 2.0), arch(12, -2.0)
    travel = 14.0 * np.sin(np.radians(_turn(upper, lower, 14.0)))
    np.testing.assert_allclose(travel, WANDER * [12, opening_height(upper, lower)], rtol=1e-12)
    assert travel[0] < 6 and travel[1] <= 2
    R = Rotation.from_rotvec([0.1, 0.2, 0.3]).as_matrix()
    np.testing.assert_allclose(_turn(3 * upper @ R.T, 3 * lower @ R.T, 42.0), _turn(upper, lower, 14.0), rtol=1e-12)
