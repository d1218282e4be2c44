"""Takes of speech."""

import numpy as np
import pytest

from toongeo.driving import VisemeTrack, speak
from toongeo.driving.speech.coarticulated import coarticulated
from toongeo.model.expression_schemes import EXPRESSIONS


@pytest.fixture
def track():
    return VisemeTrack(("sil", "aa", "PP"), np.array([0.0, 0.2, 0.5]), np.array([0.2, 0.5, 0.6]))


def test_visemes_win_and_the_sound_tells_the_length(track):
    take = speak(track, sound=(np.ones(4000), 2000.0), fps=20)
    assert take.seconds == pytest.approx(2.0)
    np.testing.assert_array_equal(take.weights, coarticulated(track, take.times))
    assert speak(track, fps=20).seconds == pytest.approx(0.85)
    np.testing.assert_allclose(take.weights[-1], 0, atol=1e-3)


def test_a_sound_alone_moves_the_jaw():
    times = np.arange(16000) / 16000
    voice = sum(np.sin(2 * np.pi * 120 * k * times) / k for k in range(1, 30))
    take = speak(sound=(np.where(times > 0.5, voice, 0), 16000.0), fps=30)
    jaw = take.weights[:, EXPRESSIONS.index("jawOpen")]
    assert take.seconds == pytest.approx(1.0) and jaw[:12].max() < 0.01 < jaw[18:27].min()


def test_nothing_to_say_is_refused(track):
    with pytest.raises(ValueError, match="visemes, sound: expected one of them, got neither"):
        speak()
    with pytest.raises(ValueError, match="fps: expected a rate > 0, got 0"):
        speak(track, fps=0)
