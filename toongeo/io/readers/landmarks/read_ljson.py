"""Landmarks of landmarker.io and menpo: ``.ljson``."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.io.readers.landmarks.file_contents import file_json
from toongeo.io.readers.landmarks.json_points import json_points
from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks, face_points

__all__ = ["is_ljson", "ljson_groups", "ljson_landmarks", "read_ljson"]


def read_ljson(path: Path, shift: int = 0) -> RawLandmarks:
    """Versions 1, 2 and 3; each group is a face. Points of pictures stand as (y, x), and so they are read.

    Raises
    ------
    ValueError, OSError
        If it is no JSON or holds no points in the form of these versions.
    """
    document = file_json(path)
    if not is_ljson(document):
        raise ValueError(f'path: expected "version" and "landmarks" or "groups" of landmarker.io, but not in {path}')
    return ljson_landmarks(document, path, shift)


def is_ljson(document: Any) -> bool:
    """Whether parsed JSON is a file of landmarker.io, or a part of one: points with their connectivity."""
    if not isinstance(document, dict):
        return False
    landmarks = document.get("landmarks")
    if isinstance(landmarks, dict) and {"points", "connectivity"} <= landmarks.keys():
        return True
    return "version" in document and bool({"landmarks", "groups"} & document.keys())


def ljson_landmarks(document: dict[str, Any], path: Path, shift: int) -> RawLandmarks:
    """The faces of a parsed file, x before y."""
    groups = ljson_groups(document, path)
    if any(points.shape[1] != 2 for points in groups):
        raise ValueError(
            f"path: expected landmarks of a picture, but {path} holds those of a mesh (read_mesh_landmarks)"
        )
    faces = tuple(face_points(points[:, ::-1], shift) for points in groups)
    return RawLandmarks("landmarker.io", (faces,), axes_doubtful=True)


def ljson_groups(document: dict[str, Any], path: Path) -> list[NDArray[np.float64]]:
    """The points (k, 2 or 3) of each group as they stand, missing ones NaN."""
    groups = document.get("groups", document)
    if isinstance(groups, dict):
        groups = [groups] if "landmarks" in groups else list(groups.values())  # version 2, version 3
    found = [_points(group) for group in groups] if isinstance(groups, list) else []
    if not found or any(points is None for points in found):
        raise ValueError(f'path: expected {{"landmarks": {{"points": [[y, x], ...]}}}} in each group of {path}')
    if document.get("version") == 1 and len(found) > 1:  # a group is a part of the face
        if len({points.shape[1] for points in found if points is not None}) > 1:
            raise ValueError(f"path: expected points of as many coordinates in all groups of {path}")
        found = [np.concatenate([points for points in found if points is not None])]
    return [points for points in found if points is not None]


def _points(group: Any) -> NDArray[np.float64] | None:
    landmarks = group.get("landmarks") if isinstance(group, dict) else None
    if isinstance(landmarks, dict):
        points = landmarks.get("points")
    elif isinstance(landmarks, list):  # version 1
        points = [entry.get("point") if isinstance(entry, dict) else entry for entry in landmarks]
    else:
        return None
    if isinstance(points, list):  # a missing point is a list of nulls
        points = [
            None if isinstance(point, list) and set(map(type, point)) == {type(None)} else point for point in points
        ]
    return json_points(points)
