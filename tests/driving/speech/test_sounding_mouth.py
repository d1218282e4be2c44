"""A mouth that goes with a sound: vowels that are made by their formants."""

import numpy as np
import pytest
import scipy.signal

from toongeo.driving.speech.sounding_mouth import sounding_mouth
from toongeo.model.expression_schemes import EXPRESSIONS

RATE = 16000
# Formants of a man, Hz, and their widths (Peterson and Barney 1952).
VOWELS = {
    "a": [(730, 80), (1090, 90), (2440, 120)],
    "i": [(270, 60), (2290, 100), (3010, 120)],
    "u": [(300, 60), (870, 90), (2240, 120)],
}
JAW, ROUND, SPREAD = (EXPRESSIONS.index(name) for name in ("jawOpen", "mouthPucker", "mouthStretchLeft"))


def vowel(name, seconds=0.4, pitch=120.0, size=1.0):
    """Pulses of a voice through resonances; of a head ``size`` times as large."""
    sound = np.zeros(round(seconds * RATE))
    sound[:: round(RATE / pitch)] = 1
    sound = scipy.signal.lfilter([1], [1, -0.95], sound)
    for frequency, width in VOWELS[name]:
        r, turn = np.exp(-np.pi * width / RATE), 2 * np.pi * frequency / size / RATE
        sound = scipy.signal.lfilter([1], [1, -2 * r * np.cos(turn), r * r], sound)
    sound = np.diff(sound, prepend=0)
    return sound / np.abs(sound).max()


def spoken(*names, **options):
    """Sound of vowels and silences ``-`` in a row, and the middle of each, s."""
    parts = [np.zeros(round(0.3 * RATE)) if name == "-" else vowel(name, **options) for name in names]
    ends = np.cumsum([len(part) for part in parts]) / RATE
    return np.concatenate(parts), ends - np.array([len(part) for part in parts]) / RATE / 2


@pytest.mark.parametrize(("pitch", "size"), [(120.0, 1.0), (220.0, 0.87)])
def test_vowels_are_told_apart(pitch, size):
    sound, middle = spoken("-", "a", "i", "u", "-", "a", "-", pitch=pitch, size=size)
    weights = sounding_mouth(sound, RATE, middle)
    _, a, i, u, _, again, _ = weights
    assert a[JAW] > 0.3 and a[JAW] > 2 * max(i[JAW], u[JAW])
    assert u[ROUND] > 0.2 > 0.1 > i[ROUND] and u[ROUND] > 2 * a[ROUND]
    assert i[SPREAD] > 0.15 > 0.05 > max(a[SPREAD], u[SPREAD])
    np.testing.assert_allclose(again, a, atol=0.05)
    np.testing.assert_allclose(weights[[0, 4, 6]], 0, atol=1e-3)


def test_loudness_and_rate_make_no_difference():
    sound, middle = spoken("-", "a", "u", "-")
    wanted = sounding_mouth(sound, RATE, middle)
    np.testing.assert_allclose(sounding_mouth(1000 * sound + 5, RATE, middle), wanted, atol=1e-6)
    finer = scipy.signal.resample_poly(sound, 3, 1)
    np.testing.assert_allclose(sounding_mouth(finer, 3 * RATE, middle), wanted, atol=0.06)


def test_silence_and_nothing_move_nothing():
    times = np.linspace(0, 1, 5)
    for sound in (np.zeros(RATE), np.zeros(0), np.full(RATE, 0.3)):
        np.testing.assert_array_equal(sounding_mouth(sound, RATE, times), 0)
    hiss = np.random.default_rng(0).standard_normal(RATE)
    weights = sounding_mouth(hiss, RATE, times)
    assert np.isfinite(weights).all() and weights.min() >= 0 and weights.max() <= 1


def test_no_sound_is_refused():
    with pytest.raises(ValueError, match=r"samples: expected finite numbers \(n,\), got shape \(2, 2\)"):
        sounding_mouth(np.zeros((2, 2)), RATE, np.zeros(1))
    with pytest.raises(ValueError, match="samples: expected finite numbers"):
        sounding_mouth(np.array([np.nan]), RATE, np.zeros(1))
    for rate in (1, 999.0, 4_294_967_291, float("nan")):  # of damaged files: filters and takes would fill the memory
        with pytest.raises(ValueError, match="rate: expected 1000 to 384000 Hz"):
            sounding_mouth(np.ones(8000), rate, np.arange(3))
    with pytest.raises(ValueError, match="rate: expected 1000 to 384000 Hz, got 0"):
        sounding_mouth(np.zeros(3), 0, np.zeros(1))


def test_blocks_of_a_long_sound_are_the_whole(monkeypatch):
    sound, times = np.random.default_rng(0).normal(size=9000), np.arange(0, 1, 0.02)
    whole = sounding_mouth(sound, 8000, times)
    monkeypatch.setattr("toongeo.driving.speech.sounding_mouth._BLOCK", 7)
    np.testing.assert_array_equal(sounding_mouth(sound, 8000, times), whole)
