"""The film of an actor beside the face that it drives."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Literal

import cv2
import numpy as np

from toongeo.io import Video

__all__ = ["Actor", "film_size", "with_actor"]

Actor = Literal["beside", "corner"]
_CORNER = 0.28  # of the picture: as picture-in-picture of meetings has it
_MARGIN = 0.03
_GROUND = 240  # grey of what the actor's picture leaves free: that behind the head


def film_size(size: int, actor: Actor | None) -> tuple[int, int]:
    """Height and width of a film whose faces have the side ``size``."""
    return (size, 2 * size) if actor == "beside" else (size, size)


def with_actor(
    frames: Iterable[np.ndarray], video: Video, actor: Actor, *, fps: float, start: float = 0.0
) -> Iterator[np.ndarray]:
    """Pictures (size, size, 3) of a face with those of the actor at the same time.

    Parameters
    ----------
    frames : pictures of the face, at ``fps``
    video : Video
    actor : {"beside", "corner"}
        On the left in full size, or small in the lower right corner.
    fps : float
    start : float, s
        Where in the film of the actor the frames begin.
    """
    pictures = _at(video, fps, start)
    for frame, picture in zip(frames, pictures, strict=False):
        size = len(frame)
        if actor == "beside":
            yield np.concatenate([_fitted(picture, size, size), frame], axis=1)
            continue
        side, margin = round(_CORNER * size), round(_MARGIN * size)
        height, width = picture.shape[:2]
        small = _fitted(
            picture, max(1, round(side * height / max(height, width))), max(1, round(side * width / max(height, width)))
        )
        shown = frame.copy()
        shown[size - margin - len(small) : size - margin, size - margin - small.shape[1] : size - margin] = small
        yield shown


def _at(video: Video, fps: float, start: float) -> Iterator[np.ndarray]:
    """The picture that is shown at each frame of the film; the last one goes on."""
    number = 0
    last = None
    for k, picture in enumerate(video):
        last = picture
        while round((start + number / fps) * video.fps, 6) < k + 1:
            yield picture
            number += 1
    while last is not None:
        yield last


def _fitted(picture: np.ndarray, height: int, width: int) -> np.ndarray:
    """A picture as large as it fits into (height, width), in the middle."""
    scale = min(height / picture.shape[0], width / picture.shape[1])
    rows, columns = (max(1, round(scale * side)) for side in picture.shape[:2])
    way = cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR
    canvas = np.full((height, width, 3), _GROUND, np.uint8)
    top, left = (height - rows) // 2, (width - columns) // 2
    canvas[top : top + rows, left : left + columns] = cv2.resize(picture, (columns, rows), interpolation=way)
    return canvas
