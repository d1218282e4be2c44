"""Films as frames."""

import cv2
import numpy as np
import pytest

from toongeo import read_video


def written(path, count=5, fps=12.0):
    """Frames of (48, 64) px that get brighter, red on the left."""
    frames = np.zeros((count, 48, 64, 3), np.uint8)
    for k in range(count):
        frames[k] = 40 * k
        frames[k, :, :32, 0] = 255
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), fps, (64, 48))
    for frame in frames:
        writer.write(np.ascontiguousarray(frame[:, :, ::-1]))
    writer.release()
    return frames


def test_frames_come_in_order_as_rgb_each_time_anew(tmp_path):
    frames = written(tmp_path / "film.avi")
    video = read_video(tmp_path / "film.avi")
    assert video.fps == 12 and video.size == (48, 64)
    for _ in range(2):
        found = np.array(list(video))
        assert found.dtype == np.uint8
        np.testing.assert_allclose(found[:, 8:40, 8:24].mean((1, 2)), frames[:, 8:40, 8:24].mean((1, 2)), atol=6)


def test_a_file_without_a_rate_has_the_usual_one(tmp_path, monkeypatch):
    written(tmp_path / "film.avi")
    monkeypatch.setattr(cv2, "CAP_PROP_FPS", -5)
    assert read_video(tmp_path / "film.avi").fps == 30


def test_what_is_no_film_is_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match="none.mp4"):
        read_video(tmp_path / "none.mp4")
    with pytest.raises(OSError, match=r"."):
        read_video(tmp_path)
    (tmp_path / "empty.mp4").write_bytes(b"")
    with pytest.raises(ValueError, match="empty.mp4: expected a video, got an empty file"):
        read_video(tmp_path / "empty.mp4")
    (tmp_path / "text.mp4").write_bytes(b"no film")
    with pytest.raises(ValueError, match="text.mp4: expected a video, got a file that OpenCV cannot open as one"):
        read_video(tmp_path / "text.mp4")
    written(tmp_path / "one.avi", 1)
    with pytest.raises(ValueError, match="one.avi: expected a video of several frames, got a single one"):
        read_video(tmp_path / "one.avi")


def test_a_film_that_changes_its_size_keeps_that_of_its_first_frame(tmp_path):
    sizes = ((96, 128), (96, 128), (64, 80), (120, 60))
    pictures = [cv2.imencode(".jpg", np.full((*size, 3), 90, np.uint8))[1].tobytes() for size in sizes]
    (tmp_path / "film.mjpeg").write_bytes(b"".join(pictures))
    video = read_video(tmp_path / "film.mjpeg")
    assert [frame.shape for frame in video] == [(96, 128, 3)] * 4


def test_a_film_without_a_frame_is_refused(tmp_path, monkeypatch):
    written(tmp_path / "film.avi")

    class Empty:
        def __init__(self, *_):
            pass

        def isOpened(self):
            return True

        def read(self):
            return False, None

        def release(self):
            pass

    monkeypatch.setattr(cv2, "VideoCapture", Empty)
    with pytest.raises(ValueError, match="film.avi: expected a video with frames, got one of which none can be"):
        read_video(tmp_path / "film.avi")
