"""A Wavefront OBJ file, its vertices in their order."""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

__all__ = ["ObjData", "read_obj"]

_Corners = list[tuple[int, int]]


@dataclass(frozen=True, eq=False)
class ObjData:
    """What an OBJ holds, as one mesh.

    Parameters
    ----------
    vertices
        (n, 3) in the file's unit and axes, in the file's order.
    faces
        (m, k) 0-based, k the most corners a polygon has; shorter ones end in -1.
    uv
        (t, 2), v up; (0, 2) if there are none.
    uv_faces
        (m, k) into ``uv``; -1 where a corner has none.
    objects
        Names by ``o`` or ``g``, in the file's order.
    face_object
        (m,) into ``objects``.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    uv: NDArray[np.float64]
    uv_faces: NDArray[np.int64]
    objects: tuple[str, ...]
    face_object: NDArray[np.int64]

    def triangles(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Each polygon as a fan about its first corner.

        Returns
        -------
        faces : (p, 3)
            Into ``vertices``.
        uv_faces : (p, 3)
            Into ``uv``, -1 where there is none.
        polygon : (p,)
            Row of ``faces`` each triangle came from, ascending.
        """
        polygon, last = np.nonzero(self.faces[:, 2:] >= 0)
        corner = np.stack([np.zeros_like(last), last + 1, last + 2], axis=1)
        row = polygon[:, None]
        return self.faces[row, corner], self.uv_faces[row, corner], polygon


def read_obj(path: str | os.PathLike[str]) -> ObjData:
    """Read vertices, uv and polygons; normals, materials, curves and vertex colours are ignored.

    Unlike trimesh's reader it neither merges nor repeats vertices, so correspondence is kept.

    Parameters
    ----------
    path
        ``.obj`` file.

    Returns
    -------
    ObjData
        All objects as one mesh.

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If a line cannot be understood (says which), an index is out of range, or there is no face.
    """
    vertices: list[list[float]] = []
    uv: list[list[float]] = []
    polygons: list[_Corners] = []
    objects: list[str] = []
    owner: list[int] = []
    # Bytes that are not UTF-8 occur in names and comments of old files, where they do no harm.
    text = Path(path).read_text(encoding="utf-8", errors="replace").replace("\\\n", " ")
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split()
        keyword = words[0] if words else ""
        try:
            if keyword == "v":
                vertices.append(_numbers(words[1:4], 3))
            elif keyword == "vt":
                uv.append(_numbers(words[1:3], 2))
            elif keyword == "f":
                polygons.append(_corners(words[1:], len(vertices), len(uv)))
                objects = objects or [""]
                owner.append(len(objects) - 1)
            elif keyword in ("o", "g"):
                objects.append(" ".join(words[1:]))
        except ValueError as error:
            raise ValueError(f"path: line {number} of {path} is {line.strip()[:60]!r}: {error}") from error
    if not polygons:
        raise ValueError(f"path: expected an OBJ with faces, got none in {path}")
    return ObjData(
        vertices=np.array(vertices).reshape(-1, 3),
        faces=_padded(polygons, 0),
        uv=np.array(uv).reshape(-1, 2),
        uv_faces=_padded(polygons, 1),
        objects=tuple(objects),
        face_object=np.array(owner),
    )


def _numbers(words: list[str], count: int) -> list[float]:
    values = [float(word) for word in words]
    if len(values) != count or not np.isfinite(values).all():
        raise ValueError(f"expected {count} finite numbers")
    return values


def _corners(words: list[str], vertices: int, uv: int) -> _Corners:
    """(vertex, uv) of each corner, 0-based, uv -1 if it has none."""
    if len(words) < 3:
        raise ValueError(f"expected at least 3 corners, got {len(words)}")
    corners = []
    for word in words:
        parts = word.split("/")
        second = parts[1] if len(parts) > 1 else ""
        corners.append((_index(parts[0], vertices), _index(second, uv) if second else -1))
    return corners


def _index(word: str, count: int) -> int:
    """0-based; a negative number counts from the latest element."""
    given = int(word)
    index = given - 1 if given > 0 else count + given
    if given == 0 or not 0 <= index < count:
        raise ValueError(f"index {given} is out of range, {count} elements so far")
    return index


def _padded(polygons: list[_Corners], column: int) -> NDArray[np.int64]:
    lengths = np.array([len(polygon) for polygon in polygons])
    padded = np.full((len(polygons), lengths.max()), -1, dtype=np.int64)
    padded[np.arange(lengths.max()) < lengths[:, None]] = [c[column] for polygon in polygons for c in polygon]
    return padded
