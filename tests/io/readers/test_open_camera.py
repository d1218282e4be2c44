"""A film that plays as a camera, cameras that are not there, and one that is simulated."""

import time

import cv2
import numpy as np
import pytest

from tests.io.readers.test_read_video import written
from toongeo.io import open_camera
from toongeo.io.readers import open_camera as module


def test_a_film_plays_at_its_own_speed(tmp_path):
    frames = written(tmp_path / "film.avi", 4, fps=20)
    began = time.monotonic()
    seen = list(open_camera(tmp_path / "film.avi"))
    assert time.monotonic() - began >= 0.15
    assert [when for _, when in seen] == [0, 0.05, 0.1, 0.15]
    np.testing.assert_allclose([frame[24, 16] for frame, _ in seen], frames[:, 24, 16], atol=8)


def test_whoever_is_slow_misses_frames(tmp_path, monkeypatch):
    written(tmp_path / "film.avi", 5, fps=10)
    clock = iter([0.0, 0.0, 0.35, 0.35, 0.35, 0.45])  # the start, then when each frame is asked for
    monkeypatch.setattr(module.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(module.time, "sleep", lambda seconds: None)
    times = [when for _, when in open_camera(str(tmp_path / "film.avi"))]
    np.testing.assert_allclose(times, [0, 0.3, 0.4])


class Simulated:
    """A camera that sees three blue frames."""

    frames = 3

    def __init__(self, number):
        self.left, self.asked, self.is_open = self.frames, [], True

    def isOpened(self):
        return self.is_open

    def set(self, name, value):
        self.asked.append(name)

    def read(self):
        self.left -= 1
        blue = np.zeros((4, 4, 3), np.uint8)
        blue[..., 0] = 200
        return (True, blue) if self.left >= 0 else (False, None)

    def release(self):
        self.is_open = False


def test_a_camera_gives_rgb_with_growing_times(monkeypatch):
    made = []
    monkeypatch.setattr(cv2, "VideoCapture", lambda number: made.append(Simulated(number)) or made[-1])
    seen = list(open_camera("0"))
    assert len(seen) == 3 and all(frame[0, 0].tolist() == [0, 0, 200] for frame, _ in seen)
    times = [when for _, when in seen]
    assert times[0] >= 0 and times == sorted(set(times))
    assert not any(capture.is_open for capture in made)
    monkeypatch.setattr(Simulated, "frames", 0)
    with pytest.raises(OSError, match="camera 0 gives no picture"):
        open_camera(0)


def test_what_is_not_there_is_named(tmp_path):
    level = cv2.utils.logging.getLogLevel()
    with pytest.raises(OSError, match="camera 97: there is none, or another program holds it"):
        open_camera(97)
    assert cv2.utils.logging.getLogLevel() == level
    with pytest.raises(ValueError, match="camera: expected a number from 0 on or a film, got -1"):
        open_camera("-1")
    with pytest.raises(FileNotFoundError, match="none.mp4"):
        open_camera(tmp_path / "none.mp4")
