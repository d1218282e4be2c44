"""Weights read off a film of which they are known, at once and frame by frame."""

import numpy as np
import pytest

from tests.driving.conftest import film, rms, smooth_weights
from toongeo import ExpressionDriver, LandmarkDriver, LandmarkTracker, VideoDriver, track_landmarks
from toongeo.driving.performer_of_frames import performer_of_frames
from toongeo.driving.video_driver import CAUTION
from toongeo.model.expression_schemes import EXPRESSIONS

LIVELY = EXPRESSIONS.index("mouthSmileLeft")


@pytest.fixture(scope="module")
def weights(performance):
    return VideoDriver().frames(performance.frames, performance.fps)


def test_weights_of_a_film_are_nearer_to_the_truth_than_none(performance, weights):
    seen, acted = ~performance.hidden, performance.weights.any(axis=0)
    truth = performance.weights[seen]
    found = weights[seen, :46]
    # 0.45 is what it reaches: on a short film of a small face the found points are the limit.
    assert rms(found[:, acted] - truth[:, acted]) < 0.5 * rms(truth[:, acted])
    assert rms(found[:, ~acted]) < 0.1
    assert (weights >= 0).all() and (weights <= 1).all() and (weights[:, 46:] == 0).all()


def test_a_performer_who_is_known_is_read_by_landmarks(performance):
    """An iterator can be gone through once only."""
    frames = performance.frames[2:5]
    found = VideoDriver(performance.landmarks[2]).frames(iter(frames), performance.fps)
    points = track_landmarks(frames, fps=performance.fps).points
    wanted = LandmarkDriver(performance.landmarks[2], caution=CAUTION).frames(points, performance.fps)
    np.testing.assert_array_equal(found, wanted)


def test_a_neutral_frame_is_found_among_lively_ones(avatar, rng):
    """Of exact landmarks; the frames that show nothing come last."""
    truth = np.concatenate([smooth_weights(rng, avatar.names, 24), np.zeros((6, 46))])
    points = film(avatar, truth, moving=False)
    rig = performer_of_frames(points)
    assert rms(LandmarkDriver(rig).frames(points)[24:, :46]) < 0.05


def test_points_that_miss_leave_the_neutral_frame_to_others(avatar, rng):
    truth = np.concatenate([np.zeros((6, 46)), smooth_weights(rng, avatar.names, 12)])
    points = film(avatar, truth)
    points[0] = np.nan
    points[7, :17] = np.nan
    rig = performer_of_frames(points)
    assert rms(LandmarkDriver(rig).frames(points)[1:6, :46]) < 0.05


def test_frames_one_by_one_drive_too(performance):
    """What a camera needs: the tracker, and the driver of a performer who looked neutral once."""
    tracker = LandmarkTracker()
    faces = [tracker.track(frame, k / 10) for k, frame in enumerate(performance.frames)]
    live = LandmarkDriver(faces[2].points, caution=CAUTION).live()
    nothing = np.full((68, 2), np.nan)
    found = np.array([live(nothing if face.lost else face.points, k / 10) for k, face in enumerate(faces)])
    acted = performance.weights.any(axis=0)
    seen = ~performance.hidden
    truth = performance.weights[seen][:, acted]
    assert rms(found[seen, :46][:, acted] - truth) < rms(truth)
    held = found[performance.hidden]
    np.testing.assert_array_equal(held, held[:1].repeat(len(held), 0))


def test_a_neutral_frame_that_is_told_is_neutral(performance):
    """The frame is one of those that are not found: the actor smiles in it, and seems to smile less in all others."""
    smiling = int(np.argmax(performance.weights[:, LIVELY] * ~performance.hidden))
    told = VideoDriver(neutral=smiling / performance.fps).frames(performance.frames, performance.fps)
    assert told[smiling].max() < 0.2 < performance.weights[smiling, LIVELY]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"neutral": 9.0}, "neutral: expected a time in the film of 0.60 s, got 9.0"),
        ({"neutral": np.nan}, "neutral: expected a number of seconds >= 0, got nan"),
        ({"neutral": -1}, "neutral: expected a number of seconds >= 0, got -1"),
        ({"neutral": 0.5}, "neutral: expected a time at which the whole face is seen, got 0.5"),
        ({"neutral": 0, "performer": np.zeros((68, 2))}, "neutral: expected none for a performer whose neutral face"),
    ],
)
def test_a_neutral_frame_that_cannot_be_is_refused(performance, options, message):
    with pytest.raises(ValueError, match=message):
        VideoDriver(**options).frames(performance.frames[8:14], performance.fps)


def test_it_is_a_driver_and_names_what_is_wrong():
    driver: ExpressionDriver = VideoDriver()
    assert len(driver.names) == 54
    with pytest.raises(ValueError, match="frames: expected at least one frame, got none"):
        driver.frames([])
    for caution in (0, np.nan):
        with pytest.raises(ValueError, match="caution: expected a factor > 0"):
            LandmarkDriver(caution=caution)
    with pytest.raises(ValueError, match="landmarks: expected at least one point, but all rows are NaN"):
        LandmarkDriver().frames(np.full((3, 68, 2), np.nan))
