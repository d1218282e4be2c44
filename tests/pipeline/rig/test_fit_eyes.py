import dataclasses

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.pipeline import align_face, build_rig, fit_3dmm, fit_eyes
from toongeo.pipeline.align.carry_inner_parts import opening_rim
from toongeo.pipeline.rig.fit_eyes import RIM, _inset, _radius_within, _robust_sphere


def test_sphere_through_exact_points_is_found(rng):
    directions = rng.normal(size=(60, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    points = np.array([1.0, 2, 3]) + 12 * directions
    centre, radius = _robust_sphere(points, np.ones(60), np.array([1.2, 1.9, 3.1]), 12.1, RIM)
    np.testing.assert_allclose([*centre, radius], [1, 2, 3, 12], atol=0.05)


def test_the_sphere_is_robust_and_equivariant(rng):
    directions = rng.normal(size=(60, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    points = 12 * directions
    points[:4] *= 3
    centre, radius = _robust_sphere(points, np.ones(60), np.zeros(3), 12.0, RIM)
    assert np.linalg.norm(centre) < 0.5
    R, t = Rotation.from_rotvec([0.1, 0.4, -0.8]).as_matrix(), np.array([5.0, -3, 8])
    turned, again = _robust_sphere(2 * points @ R.T + t, np.ones(60), t, 24.0, RIM)
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


def test_the_eyeball_shrinks_to_stay_within_the_head(rng):
    assert _radius_within(np.array([[12.0, 0, 0], [0, 0, 20]]), 10.0) == 10.0
    points = rng.normal(size=(50, 3)) * 6 + [0, 0, -6]
    points = points[np.linalg.norm(points - [0, 0, 10], axis=1) > 6]
    radius = _radius_within(points, 10.0)
    distance = np.linalg.norm(points - [0, 0, 10 - radius], axis=1)
    assert radius == 8.0 or distance.min() == pytest.approx(radius, rel=1e-12)


def test_no_lid_touches_the_eyeball_of_the_neutral_face(avatar):
    model = avatar.face.model
    for side, name in enumerate(("left", "right")):
        lids = model.region(f"eyelid_upper_{name}") | model.region(f"eyelid_lower_{name}")
        lids[opening_rim(model, f"socket_{name}")] = True
        offset = avatar.face.vertices[lids] - avatar.eyes.centres[side]
        assert np.linalg.norm(offset[offset[:, 2] > 0], axis=1).min() >= avatar.eyes.radii[side]


def test_the_template_gets_its_own_eyeballs(model, cartoon):
    """Where alignment moved nothing, the sphere that belongs to the fitted face comes back."""
    fit = fit_3dmm(*cartoon("astronaut"))
    face = align_face(fit, fit.project(fit.vertices[fit.landmark_vertices]))
    eyes = fit_eyes(face, build_rig(face))
    for side in (0, 1):
        centre, radius = model.eyes[side].placed(fit.identity)
        inset = eyes.report[f"inset_{('left', 'right')[side]}_mm"]
        np.testing.assert_allclose(eyes.centres[side] + [0, 0, inset], centre, atol=1e-4)
        assert eyes.radii[side] == pytest.approx(radius, abs=1e-4)


def test_gaze_turns_the_eyeball_about_its_centre(avatar):
    rest = avatar.eyes.vertices(0)
    turned = avatar.eyes.looking(0, {"eyeLookOutLeft": 1.0})
    radius = np.linalg.norm(turned - avatar.eyes.centres[0], axis=1)
    np.testing.assert_allclose(radius, avatar.eyes.radii[0], rtol=1e-6)  # the unit sphere is stored in float32
    assert turned[0, 0] > rest[0, 0] + 0.4 * avatar.eyes.radii[0]


def test_the_eyeball_goes_back_behind_cheeks_that_are_flat(cartoon):
    """Not only lids but all skin before an eyeball moves it in."""
    face = align_face(fit_3dmm(*cartoon("moustache_man")), cartoon("moustache_man")[1])
    rig = build_rig(face)
    eyes = fit_eyes(face, rig)
    V = face.vertices.copy()
    for side, name in enumerate(("left", "right")):
        offset = V - eyes.centres[side]
        below = face.region("skin") & ~face.region(f"eye_{name}") & (np.abs(offset[:, 0]) < 5) & (offset[:, 1] < 0)
        cheek = np.flatnonzero(below)[np.argsort(-offset[below, 1])[:20]]
        V[cheek, 1:] = eyes.centres[side][1:] + eyes.radii[side] * np.array([-0.6, 0.6])
    flat = dataclasses.replace(face, vertices=V)
    eyes = fit_eyes(flat, rig)
    for centre, radius in zip(eyes.centres, eyes.radii, strict=True):
        offset = V[face.region("skin")] - centre
        assert np.linalg.norm(offset[offset[:, 2] > 0], axis=1).min() >= radius
