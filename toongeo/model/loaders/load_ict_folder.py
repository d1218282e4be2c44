"""The folder of ICT-FaceKit, as it is published."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.io import atomic_write, read_obj
from toongeo.model.loaders.files.obj_vertices import obj_vertices
from toongeo.model.loaders.load_ict_facekit import ict_model, load_ict_facekit, packed_ict
from toongeo.model.morphable_model import MorphableModel
from toongeo.reading.promise import promise

__all__ = ["ict_folder", "load_ict_folder"]

_NEUTRAL, _INDICES = "generic_neutral_mesh.obj", "vertex_indices.json"


def ict_folder(path: Path) -> Path | None:
    """The folder ``FaceXModel`` in or at a path; None if it is none."""
    for folder in (path, path / "FaceXModel"):
        if (folder / _NEUTRAL).is_file():
            return folder
    return None


def load_ict_folder(path: str | Path, cache: str | Path | None = None) -> MorphableModel:
    """ICT-FaceKit from its folder ``FaceXModel``: a mesh each for the neutral face, 100 identities and 57 expressions.

    Parameters
    ----------
    path : str or Path
        ``FaceXModel``, or the folder that holds it. Files ``identity*.obj`` are modes of identity, one standard
        deviation each; all others, but that of the neutral face, are expressions.
    cache : str or Path, optional
        An ``.npz`` to write the first time and to read from then on. Nothing is written unless it is given.

    Raises
    ------
    ValueError
        If files are missing, or not all of one topology.

    See Also
    --------
    load_ict_facekit : what the model holds; reads the cache.
    """
    if cache is not None and Path(cache).is_file():
        return load_ict_facekit(cache)
    path = Path(path)
    with promise(path, "the folder of ICT-FaceKit", alone=True):
        folder = ict_folder(path)
        if folder is None:
            raise ValueError(f"{path}: expected {_NEUTRAL} in it or in FaceXModel, got none")
        z = _arrays(folder)
        if cache is not None:
            atomic_write({Path(cache): packed_ict(z)})
            return load_ict_facekit(cache)
        return ict_model(path, z)


def _arrays(folder: Path) -> dict[str, Any]:
    mesh = read_obj(folder / _NEUTRAL)
    if mesh.faces.shape[1] != 4:
        raise ValueError(f"{_NEUTRAL}: expected quads and triangles, got polygons of {mesh.faces.shape[1]} corners")
    indices = json.loads((folder / _INDICES).read_text(encoding="utf-8"))
    files = sorted(path for path in folder.glob("*.obj") if path.name != _NEUTRAL)
    people = [path for path in files if path.stem.startswith("identity")]
    others = [path for path in files if not path.stem.startswith("identity")]
    neutral = mesh.vertices.astype(np.float32)
    return {
        "neutral": neutral,
        "quads": mesh.faces,
        "quads_uv": mesh.uv_faces,
        "uv": mesh.uv.astype(np.float32),
        "identity": _differences(people, neutral),
        "expression": _differences(others, neutral),
        "expression_names": np.array([path.stem for path in others]),
        "landmarks68": np.asarray(indices["idx_to_landmark_verts"]),
    }


def _differences(files: list[Path], neutral: NDArray[np.float32]) -> NDArray[np.float32]:
    """Displacements (k, v, 3), cm."""
    found = np.empty((len(files), *neutral.shape), np.float32)
    for k, path in enumerate(files):
        vertices = obj_vertices(path)
        if vertices.shape != neutral.shape:
            raise ValueError(
                f"{path.name}: expected {len(neutral)} vertices as of the neutral face, got {len(vertices)}"
            )
        found[k] = vertices - neutral
    return found
