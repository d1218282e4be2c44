"""Landmarks filmed from known weights give these weights back, and noise is not taken for expression."""

import numpy as np
import pytest

from tests.driving.conftest import film, moves_landmarks, rms, smooth_weights
from toongeo.driving import LandmarkDriver, LandmarkRig
from toongeo.driving.landmarks.landmark_noise import LEAST_NOISE, noise_of
from toongeo.model.expression_schemes import EXPRESSIONS

NAMES = ("moustache_man", "blue_girl", "astronaut")
RECOVERED = 0.08
STILL = 0.02


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("active", [8, 24])
def test_weights_of_a_known_performer_come_back(performers, rng, name, active):
    performer = performers[name]
    weights = smooth_weights(rng, performer.names, active=active)
    found = LandmarkDriver(performer).frames(film(performer, weights))
    moving = moves_landmarks(performer)
    assert moving.sum() > 35
    assert rms((found[:, : len(performer.names)] - weights)[:, moving]) < RECOVERED / 8
    assert found.min() >= 0 and found.max() <= 1 and not found[:, len(performer.names) :].any()


@pytest.mark.parametrize("name", NAMES)
def test_a_neutral_frame_of_the_performer_is_enough(performers, rng, name):
    performer = performers[name]
    weights = smooth_weights(rng, performer.names)
    neutral = film(performer, np.zeros((1, 46)))[0]
    found = LandmarkDriver(neutral).frames(film(performer, weights))
    assert rms((found[:, :46] - weights)[:, moves_landmarks(performer)]) < RECOVERED


def test_one_face_drives_another(performers, rng):
    """What the viewer sees: the other head moves as it would by the true weights."""
    performer, other = performers["moustache_man"], performers["blue_girl"]
    weights = smooth_weights(rng, performer.names, frames=20)
    found = LandmarkDriver(performer).frames(film(performer, weights))
    landmarks = other.face.landmark_vertices
    shown = np.array([other.vertices(row)[landmarks] for row in found])
    wanted = np.array([other.vertices(row)[landmarks] for row in weights])
    still = other.vertices()[landmarks]
    assert rms(shown - wanted) < 0.02 * rms(wanted - still)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("posed", [False, True])
def test_a_still_noisy_face_stays_still(performers, rng, name, posed):
    performer = performers[name]
    pose = smooth_weights(rng, performer.names)[30] * posed
    still = film(performer, np.tile(pose, (90, 1)), moving=False)
    found = LandmarkDriver(performer).frames(still + rng.standard_normal(still.shape))
    assert found.std(axis=0).max() < STILL
    assert rms((found[:, :46] - pose)[:, moves_landmarks(performer)]) < RECOVERED


def test_noise_of_a_third_of_a_pixel_on_a_moving_face(performers, rng):
    performer = performers["blue_girl"]
    weights = smooth_weights(rng, performer.names)
    frames = film(performer, weights)
    found = LandmarkDriver(performer).frames(frames + rng.normal(0, 1 / 3, frames.shape))
    assert rms((found[:, :46] - weights)[:, moves_landmarks(performer)]) < RECOVERED


def test_live_follows_and_rests(performers, rng):
    performer = performers["blue_girl"]
    weights = smooth_weights(rng, performer.names)
    live = LandmarkDriver(performer).live()
    found = np.array([live(frame, i / 30) for i, frame in enumerate(film(performer, weights))])
    assert rms((found[:, :46] - weights)[:, moves_landmarks(performer)]) < RECOVERED

    still = film(performer, np.zeros((120, 46)), moving=False)
    still += rng.standard_normal(still.shape)
    live = LandmarkDriver(performer).live()
    found = np.array([live(frame, i / 30) for i, frame in enumerate(still)])
    assert found[30:].std(axis=0).max() < STILL


def test_where_the_face_is_in_the_picture_does_not_matter(performers, rng):
    performer = performers["moustache_man"]
    frames = film(performer, smooth_weights(rng, performer.names, frames=5))
    frames += rng.standard_normal(frames.shape)
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    driver = LandmarkDriver(performer)
    np.testing.assert_allclose(driver.frames(3 * frames @ turn + 1e4), driver.frames(frames), atol=1e-3)


def test_missing_points_and_frames(performers, rng):
    performer = performers["moustache_man"]
    weights = smooth_weights(rng, performer.names)
    frames = film(performer, weights)
    frames[:, [3, 13, 31]] = np.nan
    frames[20:25, 48:60] = np.nan  # a hand before the mouth: its weights are held meanwhile
    frames[40] = np.nan
    found = LandmarkDriver(performer).frames(frames)
    seen = np.r_[0:18, 27:39, 42:60]
    assert np.isfinite(found).all()
    assert rms((found[seen, :46] - weights[seen])[:, moves_landmarks(performer)]) < RECOVERED

    live = LandmarkDriver(performer).live()
    np.testing.assert_array_equal(live(frames[40], 0.0), np.zeros(54))
    before = live(frames[30], 0.1)
    np.testing.assert_array_equal(live(frames[40], 0.2), before)


def test_an_unknown_performer_is_found_in_the_sequence(performers, rng):
    performer = performers["moustache_man"]
    weights = np.zeros((40, 46))
    weights[:, performer.names.index("jawOpen")] = np.linspace(0, 0.8, 40)
    found = LandmarkDriver().frames(film(performer, weights))
    jaw = found[:, EXPRESSIONS.index("jawOpen")]
    assert np.corrcoef(jaw, weights.sum(axis=1))[0, 1] > 0.9


def test_same_input_same_weights(performers, rng):
    frames = film(performers["astronaut"], smooth_weights(rng, performers["astronaut"].names, frames=6))
    driver = LandmarkDriver(performers["astronaut"])
    np.testing.assert_array_equal(driver.frames(frames), driver.frames(frames))


def test_the_noise_is_told_from_motion(rng):
    noise = rng.normal(0, 0.004, (200, 68, 2))
    drift = np.sin(np.arange(200) / 20)[:, None, None]
    # Errors are what is left when weights and pose have taken up their part.
    left = noise * np.sqrt(1 - 40 / 136) + 0.01 * drift
    assert noise_of(left) == pytest.approx(0.004, rel=0.05)
    assert noise_of(np.zeros((10, 68, 2))) == LEAST_NOISE


@pytest.mark.parametrize(
    ("frames", "message"),
    [
        (np.zeros((3, 67, 2)), r"recording: expected shape \(frames, 68, 2\), got \(3, 67, 2\)"),
        (np.zeros((0, 68, 2)), r"recording: expected shape \(frames, 68, 2\), got \(0, 68, 2\)"),
        ("landmarks", r"recording: expected numbers \(frames, 68, 2\), got str"),
        (np.full((2, 68, 2), np.inf), "recording: expected finite px, or NaN"),
        (np.full((2, 68, 2), np.nan), "recording: expected a frame with at least 12 landmarks, got none"),
        (np.tile(np.arange(68.0)[:, None], (2, 1, 2)), "landmarks: expected points spread over a face"),
    ],
)
def test_frames_that_are_none(avatar, frames, message):
    with pytest.raises(ValueError, match=message):
        LandmarkDriver(avatar).frames(frames)


def test_other_bad_input(avatar):
    with pytest.raises(ValueError, match="fps: expected a rate > 0, got 0"):
        LandmarkDriver(avatar).frames(np.zeros((2, 68, 2)), fps=0)
    with pytest.raises(ValueError, match="performer: expected an avatar or a neutral frame for live driving"):
        LandmarkDriver().live()
    with pytest.raises(ValueError, match=r"performer: expected shape \(frames, 68, 2\)"):
        LandmarkDriver(np.zeros((5, 2)))
    with pytest.raises(ValueError, match=r"neutral, deltas: expected \(68, 3\) and \(1, 68, 3\)"):
        LandmarkRig(("jawOpen",), np.zeros((68, 3)), np.zeros((2, 68, 3)))
