"""A face followed through a film of which every landmark is known."""

import numpy as np
import pytest

from toongeo import LandmarkTrack, LandmarkTracker, detect_faces, track_landmarks
from toongeo.metrics import landmark_error
from toongeo.pipeline import NoFaceError
from toongeo.pipeline.landmarks.search.follow_face import flowed_points
from toongeo.protocols import LandmarkDetection


@pytest.fixture(scope="module")
def track(performance):
    return track_landmarks(performance.frames, fps=performance.fps)


def test_the_face_is_followed_and_lost_only_where_it_is_hidden(performance, track):
    np.testing.assert_array_equal(track.lost, performance.hidden)
    seen = ~performance.hidden
    errors = [
        landmark_error(found, truth)["inner51"]
        for found, truth in zip(track.points[seen], performance.landmarks[seen], strict=True)
    ]
    assert np.mean(errors) < 0.04 and np.max(errors) < 0.08
    np.testing.assert_allclose(track.times, np.arange(24) / 10)
    assert track.confidence[seen].mean() > 0.8 and (track.score[seen] > 0.5).all()


def test_a_lost_face_is_held(performance, track):
    before = int(np.flatnonzero(performance.hidden)[0]) - 1
    for points in track.points[performance.hidden]:
        np.testing.assert_array_equal(points, track.points[before])
    assert (track.confidence[track.lost] == 0).all() and (track.score[track.lost] == 0).all()
    assert np.isnan(track.seen[track.lost]).all() and np.isfinite(track.seen[~track.lost]).all()


def test_frames_one_by_one_give_the_same_bytes(performance, track):
    tracker = LandmarkTracker(thorough=True)
    for k in range(4):
        face = tracker.track(performance.frames[k], k / 10)
        assert face.points.tobytes() == track.points[k].tobytes()
        assert face.confidence.tobytes() == track.confidence[k].tobytes()
    with pytest.raises(ValueError, match="read-only"):
        face.points[0] = 0


def test_a_face_that_comes_back_elsewhere_is_found_within_half_a_second(performance, track):
    frame = np.pad(performance.frames[0], ((0, 0), (0, 160), (0, 0)), "edge")
    elsewhere = np.pad(performance.frames[0], ((0, 0), (160, 0), (0, 0)), "edge")
    blank = np.full_like(frame, 90)
    found = track_landmarks([frame, blank, blank, *[elsewhere] * 5], fps=10)
    back = np.flatnonzero(~found.lost[3:])
    assert found.lost[1:3].all() and back[0] <= 4
    moved = found.points[3 + back[0]] - [160, 0]
    assert landmark_error(moved, performance.landmarks[0])["inner51"] < 0.06


def test_a_face_that_comes_late_has_no_points_before(performance):
    found = track_landmarks([np.full_like(performance.frames[0], 90), *performance.frames[:3]], fps=4)
    assert found.lost.tolist() == [True, False, False, False] and np.isnan(found.points[0]).all()


def test_of_several_faces_the_one_that_was_followed_is_taken_up_again(performance):
    truth = performance.landmarks[0]

    def detector(img):
        calls.append(img)
        faces = [LandmarkDetection(truth, np.ones(68), 1.0), LandmarkDetection(truth + 90, np.ones(68), 1.0)]
        return faces if len(calls) == 1 else faces[::-1]

    calls = []
    tracker = LandmarkTracker(detector)
    blank = np.full_like(performance.frames[0], 90)
    faces = [tracker.track(frame, k) for k, frame in enumerate((performance.frames[0], blank))]
    assert len(calls) == 2
    for face in faces:
        np.testing.assert_array_equal(face.points, truth)


def test_flow_carries_points_and_gives_the_rest_the_motion_of_the_face(performance, rng):
    frame = performance.frames[0][:, :, 1]
    truth = performance.landmarks[0]
    moved = np.roll(frame, (5, -4), (0, 1))
    np.testing.assert_allclose(flowed_points(frame, moved, truth), truth + [-4, 5], atol=0.5)
    noise = rng.integers(0, 255, frame.shape, dtype=np.uint8)
    np.testing.assert_array_equal(flowed_points(frame, noise, truth), truth)


def test_bad_input_is_refused(performance):
    frame = performance.frames[0]
    with pytest.raises(NoFaceError, match="no face was found in any of 2 frames"):
        track_landmarks([np.full_like(frame, 90)] * 2)
    with pytest.raises(ValueError, match="frames: expected at least one frame"):
        track_landmarks([])
    with pytest.raises(ValueError, match="fps: expected a rate > 0, got 0"):
        track_landmarks([frame], fps=0)
    with pytest.raises(ValueError, match=r"frame: expected \(H, W, 3\) uint8 RGB, got float64"):
        track_landmarks([frame.astype(float)])
    with pytest.raises(ValueError, match="frame: expected 240 x 240 px as in the frames before, got 200 x 240"):
        track_landmarks([frame, frame[:, :200]])
    tracker = LandmarkTracker()
    tracker.track(frame, 1.0)
    for time in (1.0, np.nan):
        with pytest.raises(ValueError, match="time: expected seconds after 1.0"):
            tracker.track(frame, time)
    with pytest.raises(ValueError, match=r"lost: expected \(2,\), got \(3,\)"):
        LandmarkTrack(np.zeros((2, 68, 2)), np.zeros((2, 68)), np.zeros(2), np.zeros(3, bool), np.arange(2.0))


def test_one_frame_is_a_track_and_agrees_with_the_detector(performance):
    found = track_landmarks(performance.frames[:1])
    assert found.points[0].tobytes() == detect_faces(performance.frames[0])[0].points.tobytes()
