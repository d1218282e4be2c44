"""Landmarks as JSON: lists and objects, MediaPipe's results, COCO, OpenPose, MMPose, landmarker.io."""

import reprlib
from pathlib import Path
from typing import Any

import numpy as np

from toongeo.io.landmarks.landmark_schemes import SCHEMES
from toongeo.io.readers.landmarks.file_contents import file_json
from toongeo.io.readers.landmarks.json_points import json_number, json_points
from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks, face_points
from toongeo.io.readers.landmarks.read_ljson import is_ljson, ljson_landmarks

__all__ = ["read_json"]

# Keys under which programs keep faces; of several in one object the first.
_KEYS = (
    "frames",
    "images",
    "instance_info",  # MMPose, a video
    "annotations",  # COCO
    "people",  # OpenPose
    "instances",  # MMPose, a picture
    "predictions",
    "results",
    "faces",
    "face_landmarks",  # MediaPipe's tasks in Python
    "faceLandmarks",  # MediaPipe's tasks in JavaScript
    "multi_face_landmarks",
    "multiFaceLandmarks",
    "face_kpts",  # COCO-WholeBody
    "face_keypoints_2d",
    "landmarks",
    "landmark",
    "keypoints",
    "points",
    "face",
)
_KEYS_OF_FRAMES = ("frames", "images", "instance_info")
# Numbers a point in a flat list: two, or three with a score; the first that makes a scheme.
_FLAT = {count * width: width for width in (2, 3) for counts in SCHEMES.values() for count in counts}

_Face = np.ndarray
_Frame = list[_Face]


def read_json(path: Path, shift: int = 0) -> RawLandmarks:
    """Faces wherever they stand in the document: see `docs/landmarks.md` for the forms known.

    A list of faces is those of one picture, a list of such lists is frames.

    Raises
    ------
    ValueError, OSError
        If it is no JSON, is nested too deeply, or holds no list of points.
    """
    document = file_json(path)
    if is_ljson(document):
        return ljson_landmarks(document, path, shift)
    try:
        found = _found(document)
    except RecursionError:
        raise ValueError(f"path: {path} is nested too deeply") from None
    if found is None:
        raise ValueError(f"path: expected points [x, y] in lists or objects, got {_shown(document)} in {path}")
    frames: list[_Frame] = [[found]] if isinstance(found, np.ndarray) else _as_frames(found)
    return RawLandmarks("JSON", tuple(tuple(face_points(face, shift) for face in frame) for frame in frames))


def _found(node: Any) -> Any:
    """A face (array), the faces of a frame (list of arrays), frames (list of lists of arrays), or None."""
    face = json_points(node)
    if face is None and isinstance(node, list):
        face = _flat(node)
    if face is not None:
        return face
    if isinstance(node, list):
        each = [(part, _found(part)) for part in node]
        parts = [found for _, found in each if found is not None]
        # Somebody whose face was not looked for is left out; a face that cannot be understood is not.
        if (node and not parts) or any(found is None and not isinstance(part, dict) for part, found in each):
            return None
        if all(isinstance(part, np.ndarray) for part in parts):
            return parts
        return [frame for part in parts for frame in ([[part]] if isinstance(part, np.ndarray) else _as_frames(part))]
    if not isinstance(node, dict):
        return None
    for key in _KEYS:
        part = _found(node[key]) if key in node else None
        if part is not None and key == "annotations" and isinstance(node[key], list):
            return _by_picture(node[key])
        if part is not None:
            faces = isinstance(part, list) and all(isinstance(face, np.ndarray) for face in part)
            return [[face] for face in part] if faces and key in _KEYS_OF_FRAMES else part
    return None


def _by_picture(annotations: list[Any]) -> list[_Frame]:
    """COCO has one list of all faces of all pictures."""
    frames: dict[str, _Frame] = {}
    for annotation in annotations:
        face = _found(annotation)
        if isinstance(face, np.ndarray) and annotation.get("face_valid") is not False:
            frames.setdefault(str(annotation.get("image_id")), []).append(face)
    return list(frames.values())


def _as_frames(found: list[Any]) -> list[_Frame]:
    return [found] if all(isinstance(face, np.ndarray) for face in found) else found


def _flat(node: list[Any]) -> np.ndarray | None:
    if len(node) not in _FLAT:
        return None
    numbers = [json_number(value) for value in node]
    return None if None in numbers else np.array(numbers, np.float64).reshape(-1, _FLAT[len(node)])


def _shown(document: Any) -> str:
    if isinstance(document, dict):
        return "an object with " + ", ".join(repr(key)[:30] for key in list(document)[:8])
    if not isinstance(document, list):
        return type(document).__name__
    bad = next((k for k, point in enumerate(document) if json_points([point]) is None), None)
    why = "rows of different lengths" if bad is None else f"{reprlib.repr(document[bad])} at {bad}"
    return f"a list of {len(document)} with {why}"
