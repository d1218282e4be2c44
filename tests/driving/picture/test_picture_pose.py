"""A face whose skin is known, found again in pictures."""

from dataclasses import replace

import numpy as np
import pytest

from toongeo.driving.landmark_rig import LandmarkRig, PerformerFace
from toongeo.driving.landmarks.landmark_pose import LandmarkPose
from toongeo.driving.picture.picture_pose import _jacobian, _sight, picture_error, picture_pose, slopes
from toongeo.driving.picture.reader_of_film import reader_of_film
from toongeo.driving.picture.skin_reader import SkinReader
from toongeo.driving.picture.skin_samples import posed_px
from toongeo.geometry.rotations.rotation_vectors import rotation_matrix

AT_REST, SPEAKS = 2, 5  # frames of the film


@pytest.fixture(scope="module")
def face(avatar):
    """The actor's own, as nobody knows it from a film."""
    return PerformerFace(avatar.face, avatar.rig, LandmarkRig.of_rig(avatar.rig, avatar.face.landmark_vertices))


@pytest.fixture(scope="module")
def reader(face, performance):
    return SkinReader(face, performance.frames[AT_REST], performance.landmarks[AT_REST])


@pytest.fixture(scope="module")
def spoken(reader, performance):
    """A frame as it is compared, and where the actor is in it."""
    reader.rest()
    return reader.grey(performance.frames[SPEAKS]), reader(performance.frames[SPEAKS], performance.landmarks[SPEAKS])


def test_weights_and_pose_of_a_frame_are_found(avatar, face, reader, performance, spoken):
    pose, truth = spoken[1], performance.weights[SPEAKS]
    assert np.abs(pose.weights - truth)[truth > 0].max() < 0.15 and np.abs(pose.weights - truth).max() < 0.25
    shape = face.landmarks.neutral + np.tensordot(truth, face.landmarks.deltas, 1)
    misses = np.linalg.norm(reader.larger(posed_px(shape, pose)) - performance.landmarks[SPEAKS], axis=1)
    assert np.median(misses) < 1.0


def test_at_rest_nothing_is_left_to_explain(reader, performance):
    grey = reader.grey(performance.frames[AT_REST])
    reader.rest()
    pose = reader.read(grey, performance.landmarks[AT_REST])
    assert picture_error(reader.skin, slopes(grey), pose) < 1e-3 and pose.weights.max() < 0.02


def test_light_is_no_expression(reader, spoken):
    grey, pose = spoken
    height, width = grey.shape
    lamp = 1.2 + 0.2 * np.linspace(-1, 1, width)[None] - 0.1 * np.linspace(-1, 1, height)[:, None]
    lit = (grey * lamp + 15).astype(np.float32)
    one = picture_pose(reader.skin, slopes(grey), pose)
    other = picture_pose(reader.skin, slopes(lit), pose)
    np.testing.assert_allclose(other.weights, one.weights, atol=0.06)
    even = picture_pose(reader.skin, slopes((0.5 * grey + 40).astype(np.float32)), pose)
    np.testing.assert_allclose(even.weights, one.weights, atol=0.15)


def test_derivatives_are_those_of_the_grey_values(reader, rng):
    """On a ramp, whose slopes are the same everywhere."""
    skin, k = reader.skin, len(reader.skin.rig.names)
    x, y = np.meshgrid(np.arange(400.0), np.arange(400.0))
    level = np.dstack([0.02 * x - 0.03 * y, np.full_like(x, 0.02), np.full_like(x, -0.03)])
    turn = rotation_matrix(np.array([0.1, -0.2, 0.05]))
    pose = LandmarkPose(rng.uniform(0.1, 0.3, k), 0.6, turn, np.array([200.0, 190.0]))
    move = rng.normal(size=k + 6) * np.r_[np.full(k, 0.1), np.full(6, 0.05)]

    def values(share):
        d = share * move
        moved = replace(
            pose,
            weights=pose.weights + d[:k],
            scale=pose.scale * np.exp(d[k + 3]),
            rotation=rotation_matrix(d[k : k + 3]) @ pose.rotation,
            translation=pose.translation + d[k + 4 :] * [1, -1] * pose.scale * skin.rig.width,
        )
        return _sight(skin, level, moved).values[:, 0]

    slope = _jacobian(skin, _sight(skin, level, pose), pose) @ move
    errors = [np.abs(values(h) - values(0) - h * slope).max() for h in (1e-2, 5e-3)]
    assert errors[0] < 1e-2 and errors[0] / errors[1] == pytest.approx(4, rel=0.1)  # of second order


def test_the_frame_without_expression_is_found_in_a_film(performance):
    """Landmarks that miss by as much as a brow moves say where it is, roughly; the skin says it."""
    points = np.where(performance.hidden[:, None, None], np.nan, performance.landmarks)
    reader = reader_of_film(performance.frames, points)
    reader.rest()
    pose = reader(performance.frames[AT_REST], points[AT_REST])
    assert pose.weights.sum() < 1.0
    truth = performance.weights[SPEAKS]
    found = reader(performance.frames[SPEAKS], points[SPEAKS]).weights
    assert np.abs(found - truth)[truth > 0].max() < 0.3


def test_a_wall_moves_nothing(reader, spoken):
    grey, pose = spoken
    after = picture_pose(reader.skin, slopes(np.full_like(grey, 90)), pose)
    np.testing.assert_allclose(after.rotation, pose.rotation, atol=1e-6)
    np.testing.assert_allclose(after.translation, pose.translation, atol=1e-4)
    assert (after.weights <= pose.weights + 1e-6).all()


def test_a_frame_that_shows_no_skin_is_refused(face, performance):
    away = performance.landmarks[AT_REST] + [400, 0]
    with pytest.raises(ValueError, match="frame: expected 200 places on the skin of a face, got 0"):
        SkinReader(face, performance.frames[AT_REST], away)
