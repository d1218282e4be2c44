"""A performer before a camera, of whom only the film is known."""

import numpy as np
import pytest

from tests.driving.conftest import rms
from toongeo import LiveVideo
from toongeo.driving.live_video import _brought

AT_REST = 2  # frame of the film


@pytest.fixture(scope="module")
def seen(performance):
    """Weights of the film after a moment at rest, and whether the face was known, frame by frame."""
    live = LiveVideo()
    frames = [*[performance.frames[AT_REST]] * 8, *performance.frames]
    rows = [(live(frame, k / 10), live.is_ready) for k, frame in enumerate(frames)]
    return np.array([weights for weights, _ in rows]), [ready for _, ready in rows]


def test_weights_of_a_film_come_one_by_one(performance, seen):
    weights, ready = seen
    assert ready == [False] * 7 + [True] * (len(ready) - 7)
    assert (weights[:8] == 0).all() and (weights >= 0).all() and (weights <= 1).all()
    shown, acted = ~performance.hidden, performance.weights.any(axis=0)
    found, truth = weights[8:][shown, :46], performance.weights[shown]
    assert rms(found[:, acted] - truth[:, acted]) < 0.45 * rms(truth[:, acted])
    assert rms(found[:, ~acted]) < 0.08


def test_a_lost_face_is_held(performance, seen):
    held = seen[0][8:][performance.hidden]
    np.testing.assert_array_equal(held, held[:1].repeat(len(held), 0))


def test_a_restart_looks_for_a_neutral_face_again(performance):
    live = LiveVideo()
    for k in range(8):
        live(performance.frames[AT_REST], k / 10)
    live(performance.frames[6], 0.8)
    assert live.is_ready and live(performance.frames[6], 0.9).any()
    live.restart()
    assert not live.is_ready and not live(performance.frames[6], 1.0).any()


def test_points_are_brought_onto_others(rng):
    points = rng.normal(size=(68, 2))
    turned = 1.3 * points @ [[0.8, 0.6], [-0.6, 0.8]] + [3, -2]
    np.testing.assert_allclose(_brought(points, turned), turned, atol=1e-12)
