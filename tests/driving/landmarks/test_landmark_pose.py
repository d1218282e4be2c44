"""The derivative is that of the posed face."""

import numpy as np

from tests.driving.conftest import film
from toongeo.driving import LandmarkRig
from toongeo.driving.landmarks.landmark_pose import LandmarkPose, _jacobian, landmark_pose
from toongeo.geometry.rotations.rotation_vectors import rotation_matrix
from toongeo.render import ScaledOrthographicCamera


def rig_of(avatar):
    return LandmarkRig.of_rig(avatar.rig, avatar.face.landmark_vertices)


def test_jacobian_by_taylor(avatar, rng):
    rig = rig_of(avatar)
    k = len(rig.names)
    turn = rotation_matrix(np.array([0.1, -0.3, 0.2]))
    pose = LandmarkPose(rng.random(k), 1.7, turn, np.array([5.0, -3.0]))
    pixels = 300 * rng.standard_normal((68, 2))
    direction = rng.standard_normal(k + 6)
    slope = _jacobian(rig, pose) @ direction

    def errors(h):
        x = h * direction
        moved = LandmarkPose(
            pose.weights + x[:k],
            pose.scale * np.exp(x[k + 3]),
            rotation_matrix(x[k : k + 3]) @ turn,
            pose.translation + x[k + 4 :] * [1, -1] * pose.scale * rig.width,
        )
        # In the widths and the scale of the first pose, as a step sees them.
        return moved.errors(pixels, rig) * moved.scale / pose.scale

    def remainder(h):
        return np.abs(errors(h) - errors(0.0) + h * slope).max()

    steps = np.array([1e-2, 1e-3])
    order = np.log10(remainder(steps[0]) / remainder(steps[1]))
    assert 1.9 < order < 2.1


def test_pose_and_weights_are_found_from_far_away(avatar):
    rig = rig_of(avatar)
    weights = np.zeros(len(rig.names))
    weights[[rig.names.index(name) for name in ("jawOpen", "eyeBlinkLeft")]] = 0.7, 1.0
    camera = ScaledOrthographicCamera.look(yaw=-35, pitch=15, roll=40, size=500, extent=300)
    pixels = camera.project(rig.neutral + np.tensordot(weights, rig.deltas, 1))
    found = landmark_pose(rig, pixels, np.full(len(rig.names), 0.5), noise=1e-5)
    np.testing.assert_allclose(found.weights, weights, atol=2e-3)
    np.testing.assert_allclose(found.rotation, camera.rotation, atol=1e-4)
    assert np.abs(found.errors(pixels, rig)).max() < 1e-5


def test_head_frame_and_picture_are_inverse(avatar, rng):
    rig = rig_of(avatar)
    pose = landmark_pose(rig, film(avatar, np.zeros((1, 46)))[0], np.zeros(46), 1e-3)
    pixels = 100 * rng.standard_normal((68, 2))
    np.testing.assert_allclose(pose.picture(pose.head_frame(pixels, rig), rig), pixels, atol=1e-9)


def test_a_point_gone_astray_is_not_followed(avatar):
    rig = rig_of(avatar)
    pixels = film(avatar, np.zeros((1, 46)))[0]
    pixels[[8, 50]] += [60.0, 30.0]
    found = landmark_pose(rig, pixels, np.zeros(46), 1e-3)
    assert found.weights.max() < 0.1
