"""Which reader takes a file of landmarks, by the end of its name."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from toongeo.io.landmarks.landmark_schemes import SCHEMES
from toongeo.io.readers.landmarks.raw_landmarks import RawLandmarks
from toongeo.io.readers.landmarks.read_dlib_xml import read_dlib_xml
from toongeo.io.readers.landmarks.read_json import read_json
from toongeo.io.readers.landmarks.read_ljson import read_ljson
from toongeo.io.readers.landmarks.read_npy import read_npy
from toongeo.io.readers.landmarks.read_pts import read_pts
from toongeo.io.readers.landmarks.read_table import read_table
from toongeo.reading.promise import promise

__all__ = ["LANDMARK_READERS", "LandmarkReader", "raw_landmarks"]


@dataclass(frozen=True)
class LandmarkReader:
    """A function of a path and of what is subtracted from coordinates, and whether the format counts from 1."""

    read: Callable[[Path, int], RawLandmarks]
    one_based: bool = False


LANDMARK_READERS: Mapping[str, LandmarkReader] = MappingProxyType(
    {
        ".pts": LandmarkReader(read_pts, one_based=True),
        ".txt": LandmarkReader(read_table),
        ".csv": LandmarkReader(read_table),
        ".npy": LandmarkReader(read_npy),
        ".json": LandmarkReader(read_json),
        ".ljson": LandmarkReader(read_ljson),
        ".xml": LandmarkReader(read_dlib_xml),
    }
)


def raw_landmarks(path: Path, scheme: str, one_based: bool | None) -> RawLandmarks:
    """All faces of a file of any known format.

    Raises
    ------
    ValueError, OSError
        If the format or the scheme is not known, or as the reader of the format says.
    """
    reader = LANDMARK_READERS.get(path.suffix.lower())
    if reader is None:
        *most, last = LANDMARK_READERS
        raise ValueError(f"path: expected {', '.join(most)} or {last}, got {path}")
    if scheme != "auto" and scheme not in SCHEMES:
        raise ValueError(f"scheme: expected 'auto' or one of {', '.join(map(repr, SCHEMES))}, got {scheme!r}")
    with promise(path, "landmarks"):
        return reader.read(path, int(reader.one_based if one_based is None else one_based))
