from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo.io import read_landmarks
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.pipeline import denoise_landmarks, fit_3dmm
from toongeo.pipeline.align.denoise_landmarks import LandmarkNoise

FOUR = (5, 24, 33, 60)


def outer_eyes(landmarks):
    return np.linalg.norm(np.subtract(*landmarks[list(OUTER_EYES)]))


def shaken(landmarks, share, seed=0):
    return landmarks + np.random.default_rng(seed).normal(0, share * outer_eyes(landmarks), (68, 2))


def thrown(landmarks, rows=FOUR):
    """Points moved by half of the outer-eye distance, each another way."""
    out, angle = landmarks.copy(), np.arange(len(rows)) * 2.0
    out[list(rows)] += outer_eyes(landmarks) / 2 * np.stack([np.cos(angle), np.sin(angle)], -1)
    return out


def error(points, landmarks):
    return np.linalg.norm(points - landmarks, axis=1).mean() / outer_eyes(landmarks)


@pytest.fixture
def man(cartoon):
    return cartoon("moustache_man")[1]


def test_points_set_by_hand_stay_bit_for_bit(cartoon, fits):
    for name in CARTOONS:
        landmarks = cartoon(name)[1]
        found = denoise_landmarks(fits(name), landmarks)
        assert found.points.tobytes() == landmarks.tobytes(), name
        assert found.change is None and found.noise.sigma < 0.018, name


def test_so_they_do_on_portraits_and_caricatures(shared):
    files = [*(shared / "data" / "portraits").glob("*.pts"), *(shared / "data" / "caricatures").glob("*.txt")]
    for path in sorted(files):
        landmarks = read_landmarks(path)
        assert denoise_landmarks(fit_3dmm(None, landmarks), landmarks).change is None, path.name


def test_a_model_that_knows_few_faces_does_not_take_a_drawing_for_noise(cartoon, model):
    few = replace(model, identity=model.identity[:2], prior=None)
    landmarks = cartoon("bad_guy")[1]
    assert denoise_landmarks(fit_3dmm(None, landmarks, model=few), landmarks).change is None


@pytest.mark.parametrize(("share", "left"), [(0.04, 0.7), (0.08, 0.6)])
def test_noise_is_measured_and_made_less(man, share, left):
    noisy = shaken(man, share)
    found = denoise_landmarks(fit_3dmm(None, noisy), noisy)
    assert found.noise.smoothed and found.noise.sigma == pytest.approx(share, rel=0.25)
    assert error(found.points, man) < left * error(noisy, man)
    assert len(found.noise.rejected) <= 1


def test_points_that_were_thrown_off_are_found_and_the_others_kept(man):
    wrong = thrown(man)
    found = denoise_landmarks(fit_3dmm(None, wrong), wrong)
    assert found.noise.rejected == FOUR and not found.noise.smoothed
    others = np.setdiff1d(np.arange(68), FOUR)
    assert found.points[others].tobytes() == man[others].tobytes()
    assert np.linalg.norm(found.points - man, axis=1).max() < 0.1 * outer_eyes(man)


def test_noise_and_thrown_points_together(man):
    wrong = thrown(shaken(man, 0.03))
    found = denoise_landmarks(fit_3dmm(None, wrong), wrong)
    assert found.noise.smoothed and set(FOUR) <= set(found.noise.rejected)
    assert error(found.points, man) < 0.5 * error(wrong, man)


def test_missing_points_stay_missing_and_numbers_are_those_of_all_points(man):
    wrong = thrown(man, (33, 60))
    wrong[:10] = np.nan
    found = denoise_landmarks(fit_3dmm(None, wrong), wrong)
    assert found.noise.rejected == (33, 60)
    np.testing.assert_array_equal(np.isnan(found.points[:, 0]), np.arange(68) < 10)


def test_a_known_noise_is_taken_at_its_word(man):
    fit = fit_3dmm(None, man)
    moved = [np.abs(denoise_landmarks(fit, man, s).points - man).max() for s in (1e-4, 0.01, 0.1)]
    assert moved[0] < 0.05 * moved[1] < 0.05 * moved[2]
    assert denoise_landmarks(fit, man, 0.01).noise.sigma == 0.01


def test_exact_points_and_few_points_are_left_alone(man):
    wrong = thrown(man)
    few = np.where(np.arange(68)[:, None] < 23, wrong, np.nan)
    for points, noise in ((wrong, 0), (few, "auto")):
        found = denoise_landmarks(fit_3dmm(None, man), points, noise)
        assert found.points.tobytes() == points.tobytes() and found.change is None


def test_a_fit_that_meets_its_points_has_no_noise(man):
    fit = fit_3dmm(None, man)
    met = fit.project(fit.vertices[fit.landmark_vertices])
    assert denoise_landmarks(fit, met).noise == LandmarkNoise()
    assert np.isfinite(denoise_landmarks(fit, met, 0.05).points).all()


def test_the_size_of_the_picture_does_not_matter(man):
    noisy = thrown(shaken(man, 0.04))
    small, large = (denoise_landmarks(fit_3dmm(None, noisy * s), noisy * s) for s in (1.0, 8.0))
    assert small.noise.rejected == large.noise.rejected
    assert small.noise.sigma == pytest.approx(large.noise.sigma, rel=0.02)


@pytest.mark.parametrize("noise", ["some", -0.1, np.nan, np.inf])
def test_nonsense_is_refused(man, noise):
    with pytest.raises(ValueError, match="noise: expected 'auto' or a number >= 0"):
        denoise_landmarks(fit_3dmm(None, man), man, noise)


def test_it_says_what_was_done():
    assert str(LandmarkNoise(0.034, True, (3, 60))) == (
        "the landmarks have noise of 3.4 % of the outer-eye distance: all points were smoothed; put where the others "
        "have them: 3, 60"
    )
    assert "the other points were kept" in str(LandmarkNoise(0.005, False, (3,)))
