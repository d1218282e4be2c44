"""Lids of a face that is known, read off pictures of it."""

import numpy as np
import pytest

from tests.driving.conftest import rms
from toongeo.driving.landmark_rig import LandmarkRig, PerformerFace
from toongeo.driving.landmarks.landmark_pose import LandmarkPose
from toongeo.driving.picture.eye_aperture import eye_apertures
from toongeo.driving.picture.picture_pose import picture_pose, slopes
from toongeo.driving.picture.skin_reader import SkinReader
from toongeo.render import ScaledOrthographicCamera

SIZE_PX = 320


@pytest.fixture(scope="module")
def width(avatar):
    return float(np.ptp(avatar.rig.neutral[avatar.face.landmark_vertices, 0]))


@pytest.fixture(scope="module")
def seen(avatar, width):
    """``seen(**weights)`` -> what a camera sees of the actor: grey values and their slopes, and the pose."""
    rig = LandmarkRig.of_rig(avatar.rig, avatar.face.landmark_vertices)

    def picture(yaw=0.0, **weights):
        row = np.zeros(len(avatar.names))
        row[[avatar.names.index(name) for name in weights]] = list(weights.values())
        camera = ScaledOrthographicCamera.look(yaw=yaw, size=SIZE_PX, extent=2.1 * width)
        frame = avatar.render(row, SIZE_PX, camera=camera).astype(np.float32).mean(axis=2)
        shift = camera.project(np.zeros((1, 3)))[0]
        scale = float(np.linalg.norm(camera.project(np.array([[0, 1.0, 0]]))[0] - shift))
        pose = LandmarkPose(
            row * [name not in ("eyeBlinkLeft", "eyeBlinkRight") for name in avatar.names],
            scale,
            camera.rotation,
            shift,
        )
        return slopes(frame)[-1], pose

    return rig, picture


@pytest.fixture(scope="module")
def eyes(seen):
    rig, picture = seen
    return eye_apertures(rig, *picture())


@pytest.mark.parametrize("blink", np.arange(10) / 10)
@pytest.mark.parametrize("yaw", [0.0, 15.0])
def test_a_lid_is_found_at_every_height(avatar, seen, eyes, blink, yaw):
    level, pose = seen[1](yaw, eyeBlinkLeft=blink, eyeBlinkRight=blink, jawOpen=0.3)
    assert [avatar.names[eye.blink] for eye in eyes] == ["eyeBlinkRight", "eyeBlinkLeft"]
    np.testing.assert_allclose([eye.closed(level, pose) for eye in eyes], blink, atol=0.22)


def test_a_wink_is_of_one_eye(seen, eyes):
    right, left = (eye.closed(*seen[1](eyeBlinkLeft=0.8)) for eye in eyes)
    assert right < 0.05 and left > 0.65


def test_light_closes_no_eye(seen, eyes):
    level, pose = seen[1](eyeBlinkLeft=0.5)
    for eye in eyes:
        assert eye.closed(0.6 * level, pose) == pytest.approx(eye.closed(level, pose), abs=0.05)


def test_of_an_eye_that_looks_like_its_lid_nothing_is_told(seen):
    rig, picture = seen
    level, pose = picture()
    assert eye_apertures(rig, np.full_like(level, level[..., 0].mean()), pose) == ()


def test_a_blink_of_three_frames_is_seen_to_the_full(avatar, performance):
    """Where steps from frame to frame find half of it at most; and open eyes stay open."""
    face = PerformerFace(avatar.face, avatar.rig, LandmarkRig.of_rig(avatar.rig, avatar.face.landmark_vertices))
    reader = SkinReader(face, performance.frames[2], performance.landmarks[2])
    blinks = [avatar.names.index(f"eyeBlink{side}") for side in ("Left", "Right")]
    shown = np.flatnonzero(~performance.hidden)
    found = np.array([reader(performance.frames[k], performance.landmarks[k]).weights[blinks] for k in shown])
    truth = performance.weights[shown][:, blinks]
    assert truth.max() > 0.9
    assert rms(found - truth) < 0.1 and np.abs(found[truth == 0]).max() < 0.15


def test_weights_that_are_held_stay(avatar, performance):
    face = PerformerFace(avatar.face, avatar.rig, LandmarkRig.of_rig(avatar.rig, avatar.face.landmark_vertices))
    reader = SkinReader(face, performance.frames[2], performance.landmarks[2])
    start = reader(performance.frames[5], performance.landmarks[5])
    levels = slopes(reader.grey(performance.frames[6]))
    held = [3, 7]
    pose = picture_pose(reader.skin, levels, start, held=held)
    np.testing.assert_array_equal(pose.weights[held], start.weights[held])
    assert not np.array_equal(pose.weights, start.weights)
