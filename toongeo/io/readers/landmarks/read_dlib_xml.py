"""Landmarks of dlib and its imglab: ``.xml``."""

from pathlib import Path

import numpy as np

from toongeo.io.landmarks.landmark_schemes import SCHEMES
from toongeo.io.readers.landmarks.number_words import number
from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks
from toongeo.io.readers.landmarks.xml_elements import xml_elements

__all__ = ["read_dlib_xml"]

_COUNTS = frozenset(count for counts in SCHEMES.values() for count in counts)
_MOST_POINTS = 10_000  # of one face

_Parts = dict[int, tuple[float, float]]


def read_dlib_xml(path: Path, shift: int = 0) -> RawLandmarks:
    """A data set of imglab: each image is a frame, each box with parts a face, each part a point by its name.

    Parts that are not there are missing points. Names count from 0, or from 1 if that makes a scheme.

    Raises
    ------
    ValueError, OSError
        If it is no such XML, or a part has no number as name or place.
    """
    frames: list[list[_Parts]] = []

    def visit(element: str, attributes: dict[str, str], line: int) -> None:
        if element == "image":
            frames.append([])
        elif element == "box" and frames:
            frames[-1].append({})
        elif element == "part" and frames and frames[-1]:
            name = attributes.get("name", "")
            x, y = (number(attributes.get(axis, ""), shift) for axis in "xy")
            if not (name.isdecimal() and len(name) < 6 and int(name) < _MOST_POINTS) or x is None or y is None:
                got = ", ".join(f"{key}={value[:20]!r}" for key, value in list(attributes.items())[:3])
                raise ValueError(
                    f"path: expected numbers as name, x and y of a part, got {got} in line {line} of {path}"
                )
            frames[-1][-1][int(name)] = x, y

    xml_elements(path, visit)
    if not frames:
        raise ValueError(f"path: expected <image> with <box> and <part> of dlib's imglab, but not in {path}")
    return RawLandmarks("dlib", tuple(tuple(_array(parts) for parts in frame if parts) for frame in frames))


def _array(parts: _Parts) -> np.ndarray:
    if 0 not in parts and max(parts) in _COUNTS:
        parts = {name - 1: place for name, place in parts.items()}
    count = max(parts) + 1
    # The last parts may be missing as well: between the 51 inner points and all 68 there is no scheme.
    points = np.full((68 if 51 < count < 68 else count, 2), np.nan)
    points[list(parts)] = list(parts.values())
    return points
