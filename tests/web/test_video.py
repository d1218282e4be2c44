"""Films in a browser: it plays them, knows how long they are, and goes to any place in them."""

import importlib.util
import wave

import cv2
import numpy as np
import pytest

from toongeo.app.video import write_video as module
from toongeo.app.video.sound import Sound
from toongeo.app.video.write_video import write_video

FPS, COUNT, SIZE = 10, 20, 64
HAS_PYAV = importlib.util.find_spec("av") is not None
KINDS = [(suffix, pyav) for suffix in (".mp4", ".webm") for pyav in ((False, True) if HAS_PYAV else (False,))]


def pictures():
    """Grey that grows with time: a picture tells when it is."""
    return [np.full((SIZE, SIZE, 3), 20 + 10 * k, np.uint8) for k in range(COUNT)]


@pytest.fixture(scope="module")
def tone(tmp_path_factory):
    path = tmp_path_factory.mktemp("tone") / "tone.wav"
    samples = (8000 * np.sin(2 * np.pi * 440 * np.arange(2 * 16000) / 16000)).astype("<i2")
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(16000)
        file.writeframes(samples.tobytes())
    return path


@pytest.fixture(scope="module")
def visit(browse, serve, tone, tmp_path_factory):
    folder = tmp_path_factory.mktemp("films")
    films = []
    with pytest.MonkeyPatch.context() as patch:
        for suffix, pyav in KINDS:
            patch.setattr(module, "has_pyav", lambda pyav=pyav: pyav)
            films.append(f"{'pyav' if pyav else 'opencv'}{suffix}")
            write_video(folder / films[-1], pictures(), SIZE, FPS, sound=Sound(tone) if pyav else None)
    # As a blob, for Python's server knows no ranges of bytes, without which a browser seeks nowhere.
    script = """(async () => {
      const video = document.createElement('video');
      const canvas = document.createElement('canvas');
      video.src = URL.createObjectURL(await (await fetch('/FILM')).blob());
      const event = (name) => new Promise((done) => video.addEventListener(name, done, { once: true }));
      await event('canplaythrough');
      const seen = { ready: video.readyState, duration: video.duration, size: [video.videoWidth, video.videoHeight] };
      const seeked = event('seeked');
      video.currentTime = 1.25;
      await seeked;
      Object.assign(canvas, { width: 8, height: 8 });
      const context = canvas.getContext('2d');
      context.drawImage(video, 0, 0, 8, 8);
      seen.grey = context.getImageData(4, 4, 1, 1).data[0];
      video.muted = true;
      video.currentTime = 0;
      await video.play();
      await event('timeupdate');
      seen.sound = video.webkitAudioDecodedByteCount;
      seen.error = video.error;
      video.pause();
      return seen;
    })()"""
    (folder / "empty.html").write_text("<!doctype html><title>Films</title><link rel='icon' href='data:,'>")
    with serve(folder) as site:
        report, _ = browse(f"{site}/empty.html", [{"run": script.replace("FILM", film)} for film in films])
    return report, folder


@pytest.mark.parametrize("number", range(len(KINDS)), ids=lambda k: "-".join(map(str, KINDS[k])))
def test_chromium_plays_it(visit, number):
    report, _ = visit
    seen = report["results"][number]
    assert report["console"] == [] and seen["error"] is None
    assert seen["ready"] == 4 and seen["size"] == [SIZE, SIZE]
    assert seen["duration"] == pytest.approx(COUNT / FPS, abs=0.12)
    assert seen["grey"] == pytest.approx(20 + 10 * 12, abs=8)  # the frame from 1.2 s to 1.3 s
    assert (seen["sound"] > 0) == KINDS[number][1]


def test_opencv_reads_all_frames(visit):
    for suffix, pyav in KINDS:
        film = cv2.VideoCapture(str(visit[1] / f"{'pyav' if pyav else 'opencv'}{suffix}"))
        frames = []
        while (read := film.read())[0]:
            frames.append(read[1].mean())
        np.testing.assert_allclose(frames, 20 + 10 * np.arange(COUNT), atol=4)
