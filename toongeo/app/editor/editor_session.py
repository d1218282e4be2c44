"""What the editor's page asks, and the answers."""

from __future__ import annotations

import base64
import threading
from typing import Any

import cv2
import numpy as np

from toongeo.app.editor.editor_settings import editor_settings
from toongeo.app.editor.face_mesh import face_mesh, seen_vertices
from toongeo.app.editor.place_landmarks import place_landmarks
from toongeo.app.editor.protocols import Detector, Pictures
from toongeo.app.editor.read_points import read_points
from toongeo.arrays import Bytes, Floats
from toongeo.io import encode_image
from toongeo.model.ibug68 import OUTER_EYES
from toongeo.pipeline.fit import fit_3dmm

__all__ = ["EditorSession"]

_LONGEST_PX = 4096  # of the picture that is shown: what the textures of every graphics card hold
_FIRST_EYES = 0.28  # of the picture's shorter side: distance of the outer eye corners of a face that nobody has placed


class EditorSession:
    """Answers a page, or a widget, about pictures and their landmarks.

    Parameters
    ----------
    pictures : Pictures
    detector : Detector, optional
        Finds landmarks in a picture, or None if it sees no face; a ValueError counts as none.
    """

    def __init__(self, pictures: Pictures, detector: Detector | None = None) -> None:
        self.pictures, self.detector = pictures, detector
        self._lock = threading.Lock()
        self._held: tuple[int, Bytes] | None = None
        self._answers = {
            "list": self._list,
            "mesh": self._mesh,
            "open": self._open,
            "detect": self._detect,
            "place": self._place,
            "fit": self._refit,
            "save": self._save,
        }

    title = "Landmarks"

    def settings(self) -> dict[str, Any]:
        """What the page knows from the beginning."""
        return editor_settings() | {"detector": self.detector is not None}

    @property
    def n_pictures(self) -> int:
        """How many there are."""
        return len(self.pictures)

    def answer(self, question: str, message: dict[str, Any]) -> dict[str, Any]:
        """What a question asks, as JSON takes it.

        Raises
        ------
        ValueError
            If the question or its message is not understood, or its subject is not as it should be.
        OSError
            If a file cannot be read or written.
        """
        if question not in self._answers:
            raise ValueError(f"question: expected one of {', '.join(self._answers)}, got {question[:40]!r}")
        return self._answers[question](message)

    def shown_picture(self, k: int) -> bytes:
        """A picture as JPEG, smaller if it is too large to show."""
        img = self._picture(k)
        scale = _LONGEST_PX / max(img.shape[:2])
        if scale < 1:
            height, width = (max(1, round(scale * side)) for side in img.shape[:2])
            img = np.asarray(cv2.resize(img, (width, height), interpolation=cv2.INTER_AREA), np.uint8)
        return encode_image(img, ".jpg", quality=95)

    def _list(self, message: dict[str, Any]) -> dict[str, Any]:
        names = range(len(self.pictures))
        return {"pictures": [{"name": self.pictures.name(k), "done": self.pictures.is_done(k)} for k in names]}

    def _mesh(self, message: dict[str, Any]) -> dict[str, Any]:
        faces, colours = face_mesh()
        return {"faces": _packed(faces.astype("<u4")), "colours": _packed(colours)}

    def _open(self, message: dict[str, Any]) -> dict[str, Any]:
        k = self._number(message)
        img = self._picture(k)
        height, width = img.shape[:2]
        answer = {"width": width, "height": height, "suffix": self.pictures.target(k).suffix.lower(), "note": ""}
        try:
            points = self.pictures.landmarks(k, img)
        except (ValueError, OSError) as error:
            points, answer["note"] = None, str(error)
        if points is not None:
            missing = np.isnan(points[:, 0])
            points = _completed(points, img) if missing.any() else points
            return answer | {"source": "file", "points": points.tolist(), "missing": missing.tolist()}
        found = self._found(img)
        if found is None:
            return answer | {"source": "mean", "points": _first_guess(img).tolist(), "confidence": [0.0] * 68}
        return answer | {"source": "detected"} | found

    def _detect(self, message: dict[str, Any]) -> dict[str, Any]:
        return self._found(self._picture(self._number(message))) or {"points": None}

    def _found(self, img: Bytes) -> dict[str, Any] | None:
        if self.detector is None:
            return None
        try:
            found = self.detector(img)
        except ValueError:
            return None
        if found is None:
            return None
        return {"points": found.points.tolist(), "confidence": found.confidence.tolist()}

    def _place(self, message: dict[str, Any]) -> dict[str, Any]:
        return {"points": place_landmarks(read_points(message.get("clicks"), "clicks")).tolist()}

    def _refit(self, message: dict[str, Any]) -> dict[str, Any]:
        points = read_points(message.get("points"))
        img = self._picture(self._number(message))
        fit = fit_3dmm(img, points)
        return {
            "vertices": _packed(seen_vertices(fit).astype("<f4")),
            "landmarks": fit.project(fit.vertices[fit.landmark_vertices]).tolist(),
            "error": None if np.isnan(fit.report.rms_percent) else fit.report.rms_percent,
            "warnings": list(fit.report.warnings),
            "outliers": list(fit.report.outliers),
        }

    def _save(self, message: dict[str, Any]) -> dict[str, Any]:
        k, suffix = self._number(message), str(message.get("suffix"))
        points = read_points(message.get("points"))
        if message.get("replace") is not True and self.pictures.would_replace(k, suffix):
            return {"exists": self.pictures.target(k, suffix).name}
        return {"file": self.pictures.save(k, points, suffix).name}

    def _number(self, message: dict[str, Any]) -> int:
        k = message.get("picture")
        if not isinstance(k, int) or isinstance(k, bool) or not 0 <= k < len(self.pictures):
            raise ValueError(f"picture: expected a number below {len(self.pictures)}, got {str(k)[:40]}")
        return k

    def _picture(self, k: int) -> Bytes:
        with self._lock:
            if self._held is None or self._held[0] != k:
                self._held = k, self.pictures.picture(k)
            return self._held[1]


def _packed(array: np.ndarray) -> str:
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")


def _completed(points: Floats, img: Bytes) -> Floats:
    """Places for missing points too, so that a person can move them where they belong."""
    try:
        return place_landmarks(points)
    except ValueError:
        return np.where(np.isnan(points), _first_guess(img), points)


def _first_guess(img: Bytes) -> Floats:
    """A face from the front in the middle of the picture."""
    height, width = img.shape[:2]
    half = _FIRST_EYES * min(height, width) / 2
    clicks = np.full((68, 2), np.nan)
    clicks[list(OUTER_EYES)] = np.array([width, height]) * [0.5, 0.42] + half * np.array([[-1, 0], [1, 0]])
    return place_landmarks(clicks)
