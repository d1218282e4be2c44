"""The landmark editor in a notebook."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from toongeo.app.editor.anywidget_adapter import notebook_widget
from toongeo.app.editor.editor_session import EditorSession
from toongeo.app.editor.editor_settings import editor_settings
from toongeo.app.editor.protocols import Detector
from toongeo.arrays import Bytes, Floats
from toongeo.io import check_image, landmark_array
from toongeo.pipeline import detect_landmarks

__all__ = ["LandmarkEditor"]


class LandmarkEditor:
    """Landmarks of a picture, placed and corrected in a notebook; needs the extra ``notebook``.

    Show it as the last line of a cell, drag points, and read :attr:`landmarks` in the next one.

    Parameters
    ----------
    img : (H, W, 3) uint8 RGB
    landmarks : (68, 2) array_like, px, optional
        Where to start; NaN rows are missing. Else they are detected, or placed by clicks.
    detector : callable, optional
        Gives the `LandmarkDetection` of a picture, or None if it sees no face.

    Raises
    ------
    ImportError
        If ``anywidget`` is not installed.
    ValueError
        If the picture or the landmarks are not as above.

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> editor = tg.LandmarkEditor(img, landmarks)  # the last line of a cell shows it
    >>> editor.landmarks.shape  # as they are after dragging
    (68, 2)
    """

    def __init__(
        self, img: Bytes, landmarks: ArrayLike | None = None, *, detector: Detector = detect_landmarks
    ) -> None:
        check_image(img)
        self._picture = _OnePicture(img, None if landmarks is None else landmark_array(landmarks))
        self._session = EditorSession(self._picture, detector)
        settings = editor_settings() | {"detector": True, "isWidget": True}
        self.widget = notebook_widget(settings, self._hear)

    @property
    def landmarks(self) -> Floats | None:
        """Copy of the points (68, 2) px as they are now, NaN where missing; None as long as there are none."""
        return self._picture.landmarks(0, self._picture.picture(0))

    def _repr_mimebundle_(self, **options: Any) -> Any:
        return self.widget._repr_mimebundle_(**options)

    def _hear(self, widget: Any, message: dict[str, Any]) -> None:
        """Answer a question of the page; a picture goes along as bytes."""
        reply, buffers = {"id": message["id"]}, []
        try:
            if message["question"] == "picture":
                buffers.append(self._session.shown_picture(0))
            else:
                reply["answer"] = self._session.answer(message["question"], message["message"])
        except (ValueError, RuntimeError) as error:
            reply["error"] = str(error)
        widget.send(reply, buffers)


class _OnePicture:
    """A picture in memory, and its landmarks."""

    def __init__(self, img: Bytes, landmarks: Floats | None) -> None:
        self._img, self._landmarks = img, landmarks

    def __len__(self) -> int:
        return 1

    def name(self, k: int) -> str:
        return "Landmarks"

    def picture(self, k: int) -> Bytes:
        return self._img

    def landmarks(self, k: int, img: Bytes) -> Floats | None:
        return None if self._landmarks is None else self._landmarks.copy()

    def is_done(self, k: int) -> bool:
        return self._landmarks is not None

    def target(self, k: int, suffix: str | None = None) -> Path:
        return Path("landmarks").with_suffix(suffix or ".pts")

    def would_replace(self, k: int, suffix: str) -> bool:
        return False

    def save(self, k: int, landmarks: Floats, suffix: str) -> Path:
        self._landmarks = np.array(landmarks)
        return self.target(k, suffix)
