"""A camera, or a film that plays as if it were one."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from toongeo.io.readers.read_video import read_video

__all__ = ["Camera", "open_camera"]

_SIZE = (640, 480)  # px asked of a camera: more detail is not looked at


@dataclass(frozen=True)
class Camera:
    """Frames at the time when they are seen; whoever is slow misses some.

    Attributes
    ----------
    source : int or Path
        Number of a camera of this computer, or a film.
    """

    source: int | Path

    def __iter__(self) -> Iterator[tuple[NDArray[np.uint8], float]]:
        """Frames (H, W, 3) uint8 RGB with their times in s, from 0 on. A film ends, a camera when it is unplugged."""
        yield from _film(self.source) if isinstance(self.source, Path) else _seen(self.source)


def open_camera(source: int | str | Path) -> Camera:
    """A camera of this computer by its number, 0 for the first; or a film that is played at its own speed.

    Raises
    ------
    OSError
        If there is no such camera, another program holds it, it gives no picture, or a file cannot be read.
    ValueError
        If the number is negative, or a file is no film.
    """
    text = str(source)
    if not text.lstrip("-").isdecimal():
        read_video(text)
        return Camera(Path(text))
    if int(text) < 0:
        raise ValueError(f"camera: expected a number from 0 on or a film, got {text}")
    capture = _capture(int(text))
    has_frame = capture.read()[0]
    capture.release()
    if not has_frame:
        raise OSError(f"camera {text} gives no picture")
    return Camera(int(text))


def _capture(number: int) -> cv2.VideoCapture:
    """An open camera; OpenCV's own complaints about one that is not there are left out."""
    level = cv2.utils.logging.getLogLevel()
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
    try:
        capture = cv2.VideoCapture(number)
    finally:
        cv2.utils.logging.setLogLevel(level)
    if not capture.isOpened():
        raise OSError(f"camera {number}: there is none, or another program holds it; a film may stand in for it")
    capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)  # the frame that is, not those that were missed
    capture.set(cv2.CAP_PROP_FRAME_WIDTH, _SIZE[0])
    capture.set(cv2.CAP_PROP_FRAME_HEIGHT, _SIZE[1])
    return capture


def _film(path: Path) -> Iterator[tuple[NDArray[np.uint8], float]]:
    film = read_video(path)
    began = time.monotonic()
    for k, frame in enumerate(film):
        ahead = k / film.fps - (time.monotonic() - began)
        if ahead < -1 / film.fps:
            continue
        time.sleep(max(0.0, ahead))
        yield frame, k / film.fps


def _seen(number: int) -> Iterator[tuple[NDArray[np.uint8], float]]:
    capture = _capture(number)
    try:
        began = time.monotonic()
        while (read := capture.read())[0]:
            yield np.asarray(cv2.cvtColor(read[1], cv2.COLOR_BGR2RGB), np.uint8), time.monotonic() - began
    finally:
        capture.release()
