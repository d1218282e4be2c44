"""A model made of meshes."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from toongeo.io import ObjData, read_glb, read_obj
from toongeo.model.loaders.principal_modes import principal_modes
from toongeo.model.morphable_model import MorphableModel
from toongeo.reading.promise import promise

__all__ = ["load_shapes"]

_MOST_FILES = 2000
_NEUTRAL = ("neutral", "generic_neutral_mesh", "base", "basis", "rest", "mean", "average")
_TRIANGLES = 4  # mode of a glTF primitive


def load_shapes(
    path: str | Path,
    landmarks: NDArray[np.int64] | None = None,
    kind: Literal["auto", "blendshapes", "people"] = "auto",
) -> MorphableModel:
    """A folder of ``.obj`` files of one topology, or a ``.glb`` with morph targets, as a model.

    Parameters
    ----------
    path : str or Path
        In a folder, a file called ``neutral.obj`` (or ``..._neutral...``, ``base``, ``basis``, ``rest``, ``mean``) is
        the neutral face and each other one an expression of the name of its file. In a ``.glb`` the largest mesh with
        morph targets is taken, in metres. Otherwise the unit is the power of ten that makes a head of human size.
    landmarks : (68,) int, optional
    kind : {"auto", "blendshapes", "people"}
        ``"people"``: every file is another person; the model has their mean and principal components. ``"auto"``:
        blendshapes if there is a neutral face.

    Raises
    ------
    ValueError
        If there are no meshes, or not all of one topology, or no neutral face among blendshapes.
    """
    path = Path(path)
    if kind not in ("auto", "blendshapes", "people"):
        raise ValueError(f"kind: expected 'auto', 'blendshapes' or 'people', got {kind!r}")
    with promise(path, "meshes of one topology", alone=True):
        if path.is_dir():
            return _folder(path, landmarks, kind)
        return _glb(path, landmarks)


def _folder(folder: Path, landmarks: NDArray[np.int64] | None, kind: str) -> MorphableModel:
    files = sorted(folder.glob("*.obj"))
    if not 1 <= len(files) <= _MOST_FILES:
        raise ValueError(f"{folder}: expected 1 to {_MOST_FILES} .obj files, got {len(files)}")
    meshes = [read_obj(file) for file in files]
    for file, mesh in zip(files, meshes, strict=True):
        if mesh.vertices.shape != meshes[0].vertices.shape or not np.array_equal(mesh.faces, meshes[0].faces):
            raise ValueError(f"{file.name} has another topology than {files[0].name}")
    neutral = _neutral([file.stem for file in files])
    if kind == "people" or (kind == "auto" and neutral is None):
        mean, modes = principal_modes(np.stack([mesh.vertices for mesh in meshes]))
        return _model(meshes[0], mean, landmarks, identity=modes)
    if neutral is None:
        raise ValueError(f"{folder}: expected a file {_NEUTRAL[0]}.obj among blendshapes")
    rest = meshes[neutral].vertices
    others = [k for k in range(len(files)) if k != neutral]
    shapes = np.array([meshes[k].vertices - rest for k in others], np.float32).reshape(-1, *rest.shape)
    names = [files[k].stem for k in others]
    return _model(meshes[neutral], rest, landmarks, expression=shapes, expression_names=names)


def _neutral(stems: list[str]) -> int | None:
    lower = [stem.lower() for stem in stems]
    for name in _NEUTRAL:
        if name in lower:
            return lower.index(name)
    partly = [k for k, stem in enumerate(lower) if "neutral" in stem]
    return partly[0] if len(partly) == 1 else None


def _model(
    mesh: ObjData, mean: NDArray[np.float64], landmarks: NDArray[np.int64] | None, **shapes: object
) -> MorphableModel:
    faces, uv_faces, _ = mesh.triangles()
    has_uv = len(mesh.uv) > 0 and bool((uv_faces >= 0).all())
    whole = mesh.faces[(mesh.faces >= 0).sum(axis=1) == 4][:, :4] if mesh.faces.shape[1] >= 4 else None
    return MorphableModel.from_arrays(
        mean,
        faces,
        landmarks=landmarks,
        unit="auto",
        uv=mesh.uv if has_uv else None,
        uv_faces=uv_faces if has_uv else None,
        quads=whole if whole is not None and len(whole) else None,
        **shapes,
    )


def _glb(path: Path, landmarks: NDArray[np.int64] | None) -> MorphableModel:
    document = read_glb(path)
    found = [mesh for mesh in document.json.get("meshes", []) if mesh["primitives"][0].get("targets")]
    if not found:
        raise ValueError(f"{path}: expected a mesh with morph targets, got none")
    sizes = [len(document.accessors[mesh["primitives"][0]["attributes"]["POSITION"]]) for mesh in found]
    mesh = found[int(np.argmax(sizes))]
    part = mesh["primitives"][0]
    if part.get("mode", _TRIANGLES) != _TRIANGLES or "indices" not in part:
        raise ValueError(f"{path}: expected indexed triangles")
    mean = document.accessors[part["attributes"]["POSITION"]].astype(np.float64)
    shapes = np.stack([document.accessors[target["POSITION"]] for target in part["targets"]])
    names = mesh.get("extras", {}).get("targetNames") or [f"shape{k:03d}" for k in range(len(shapes))]
    uv = part["attributes"].get("TEXCOORD_0")
    corners = None if uv is None else document.accessors[uv][:, :2] * [1.0, -1.0] + [0.0, 1.0]  # v of glTF runs down
    faces = document.accessors[part["indices"]].astype(np.int64).reshape(-1, 3)
    return MorphableModel.from_arrays(
        mean,
        faces,
        expression=shapes,
        expression_names=names,
        landmarks=landmarks,
        unit=1000.0,  # glTF is in metres
        uv=corners,
        uv_faces=None if corners is None else faces,
    )
