"""The mesh on which landmarks are picked."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from toongeo._brief_repr import brief_repr
from toongeo._read_only import read_only
from toongeo.arrays import Bytes, Floats, Integers
from toongeo.geometry.mirror_partners import mirror_partners
from toongeo.io import MESH_SUFFIXES, SceneMesh, read_glb, read_mesh
from toongeo.model import MorphableModel, load_model, model_format

__all__ = ["PickedMesh", "picked_mesh", "picked_model"]


@dataclass(frozen=True, eq=False)
class PickedMesh:
    """Vertices in the order of their file.

    Attributes
    ----------
    vertices : (n, 3) float64, in the unit and axes of the file or, of a model, in its frame
    faces : (m, 3) int64
    colours : (n, 3) uint8 sRGB, or None
    mirror : (n,) int64 or None
        The vertex on the other side; None where the mesh is not symmetric.
    landmarks : (68,) int64 or None
        That it has already.
    """

    vertices: Floats
    faces: Integers
    colours: Bytes | None = None
    mirror: Integers | None = None
    landmarks: Integers | None = None

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        read_only(self, "vertices", "faces")


def picked_mesh(path: Path) -> PickedMesh:
    """All meshes of a file, one after the other, as ``toongeo rig`` counts their vertices.

    Raises
    ------
    OSError, ValueError
        As :func:`toongeo.io.read_mesh`.
    """
    parts = read_mesh(path).meshes
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    vertices = np.vstack([part.vertices for part in parts]).astype(np.float64)
    faces = np.vstack([part.faces + start for part, start in zip(parts, starts, strict=False)]).astype(np.int64)
    colours = None
    if any(part.texture is not None for part in parts):
        colours = np.vstack([_colours(part) for part in parts])
    return PickedMesh(vertices, faces, colours, mirror_partners(vertices))


def picked_model(
    path: Path, *, format: str | None = None, expression: Path | None = None, cache: Path | None = None
) -> PickedMesh:
    """The mean of a model, whose vertices `MorphableModel.with_landmarks` counts; else a mesh file.

    Raises
    ------
    OSError
        If a file is missing or cannot be read.
    ValueError
        If it is neither; says what would be.
    """
    if format is None and path.is_file() and path.suffix.lower() in MESH_SUFFIXES and not _has_targets(path):
        return picked_mesh(path)
    try:
        model = load_model(path, format=format or model_format(path), expression=expression, cache=cache)  # type: ignore
    except ValueError as error:
        if not str(error).startswith("path: expected a model in one of the formats"):
            raise
        meshes = ", ".join(MESH_SUFFIXES)
        raise ValueError(
            f"path: expected a model of faces or a mesh ({meshes}), got {path}; for a picture: toongeo landmarks"
        ) from error
    return _of_model(model)


def _has_targets(path: Path) -> bool:
    """Whether a GLB is a model: one with targets is, and its largest mesh is what counts."""
    if path.suffix.lower() != ".glb":
        return False
    return any(mesh["primitives"][0].get("targets") for mesh in read_glb(path).json.get("meshes", []))


def _of_model(model: MorphableModel) -> PickedMesh:
    colours = np.round(255 * model.albedo_mean).astype(np.uint8)
    upright = model.has("landmarks") or model.has("eyes")  # then the plane x = 0 is that of the face
    mirror = model.mirror if upright else mirror_partners(model.mean)
    landmarks = model.landmarks if model.has("landmarks") else None
    return PickedMesh(model.mean, model.faces, colours, mirror, landmarks)


def _colours(part: SceneMesh) -> Bytes:
    """Of the texture at every vertex: landmarks are easier to see where the skin is painted."""
    colours = np.full((len(part.vertices), 3), 200, np.uint8)
    if part.texture is None or part.uv is None:
        return colours
    height, width = part.texture.shape[:2]
    corners = part.faces if part.uv_faces is None else part.uv_faces
    texels = np.mod(part.uv, 1.0) * [width - 1, 1 - height] + [0, height - 1]
    columns, rows = np.round(texels).astype(int).T
    colours[part.faces.ravel()] = part.texture[rows, columns][corners.ravel()][:, :3]
    return colours
