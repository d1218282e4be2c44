"""Visemes that run into each other."""

import numpy as np
import pytest

from toongeo.driving import VisemeTrack
from toongeo.driving.speech import coarticulated as module
from toongeo.driving.speech.coarticulated import coarticulated
from toongeo.driving.speech.viseme_table import VISEMES
from toongeo.model.expression_schemes import EXPRESSIONS

JAW, SEAL, PUCKER = (EXPRESSIONS.index(name) for name in ("jawOpen", "mouthClose", "mouthPucker"))


def track(*rows):
    names, starts, ends = zip(*rows, strict=True)
    return VisemeTrack(names, np.array(starts, float), np.array(ends, float))


def test_it_is_the_weighted_mean_of_cohen_and_massaro():
    """A slow reference, from their Eqs. 3 and 4, at times before, in, between and after two segments."""
    rows = [("aa", 0.2, 0.4), ("CH", 0.4, 0.5)]
    for t in (0.0, 0.1, 0.3, 0.38, 0.4, 0.43, 0.45, 0.7):
        total, wanted = 0.02, np.zeros(54)
        for name, start, end in rows:
            entry, margin = VISEMES[name], (end - start) / 4
            early, late = max(start + margin - t, 0.0), max(t - (end - margin), 0.0)
            dominance = entry.strength * np.exp(-early / entry.before - late / entry.after)
            total, wanted = total + dominance, wanted + dominance * entry.weights
        np.testing.assert_allclose(coarticulated(track(*rows), np.array([t]))[0], wanted / total, atol=1e-12)


def test_a_long_viseme_is_itself_and_silence_is_still():
    times = np.array([0.0, 1.0, 2.0, 3.5, 9.0])
    weights = coarticulated(track(("sil", 0, 1.5), ("aa", 1.5, 2.5), ("sil", 2.5, 4)), times)
    np.testing.assert_allclose(weights[2], VISEMES["aa"].weights, atol=0.02)
    np.testing.assert_allclose(weights[[0, 3, 4]], 0, atol=2e-3)


@pytest.mark.parametrize("vowel", ["aa", "E", "oh"])
def test_lips_meet_between_vowels(vowel):
    """As in "abba": for a moment the lips are sealed over what the vowels leave of the jaw, which is open around."""
    times = np.arange(0, 0.6, 0.005)
    weights = coarticulated(track((vowel, 0, 0.25), ("PP", 0.25, 0.33), (vowel, 0.33, 0.6)), times)
    gap = weights[:, JAW] - weights[:, SEAL]
    assert gap.min() < 0.02 and abs(times[gap.argmin()] - 0.29) < 0.02
    assert gap[times < 0.15].min() > 0.8 * VISEMES[vowel].weights[JAW]


def test_rounding_begins_early():
    """As in "true": lips are rounded in the consonant before, more than after an open vowel."""
    times = np.array([0.15])
    rounded = coarticulated(track(("DD", 0.1, 0.2), ("ou", 0.2, 0.4)), times)[0, PUCKER]
    after = coarticulated(track(("ou", 0, 0.1), ("DD", 0.1, 0.2)), times)[0, PUCKER]
    assert rounded > after > 0.1


def test_an_hour_is_what_its_parts_are(monkeypatch):
    """Frames are mixed in blocks, of the segments that are near: the size of the blocks makes no difference."""
    rng = np.random.default_rng(1)
    starts = np.cumsum(rng.uniform(0.05, 0.4, 120))
    names = rng.choice(list(VISEMES), 120)
    spoken = VisemeTrack(tuple(names.tolist()), starts, np.r_[starts[1:], starts[-1] + 0.1])
    times = np.arange(0, 30, 1 / 30)
    whole = coarticulated(spoken, times)
    monkeypatch.setattr(module, "_FRAMES", 37)
    np.testing.assert_allclose(coarticulated(spoken, times), whole, atol=1e-9)
    assert whole.min() >= 0 and whole.max() <= 1
