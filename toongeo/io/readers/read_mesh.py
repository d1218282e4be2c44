"""A mesh file of another program, by trimesh or by our reader of OBJ."""

from __future__ import annotations

import os
import re
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from toongeo.io.readers.glb.glb_meshes import glb_meshes
from toongeo.io.readers.read_glb import read_glb
from toongeo.io.readers.read_obj import read_obj
from toongeo.io.scene import Scene, SceneMesh
from toongeo.reading.check_file import file_bytes
from toongeo.reading.promise import promised

if TYPE_CHECKING:
    import trimesh

__all__ = ["MESH_SUFFIXES", "read_mesh"]

# Required extensions of glTF that are understood, or change nothing of a mesh and its base colour.
_KNOWN = re.compile(
    "KHR_(mesh_quantization|texture_transform|lights_punctual|animation_pointer|materials_(?!pbrSpec).*)$"
    "|EXT_texture_webp$|VRM"
)
MESH_SUFFIXES = (".obj", ".ply", ".stl", ".off", ".glb")


@promised("a mesh file")
def read_mesh(path: str | os.PathLike[str]) -> Scene:
    """Read triangle meshes with their texture coordinates and textures, every vertex in its place in the file.

    OBJ goes through :func:`read_obj` and is one mesh: trimesh's reader repeats or reorders its vertices. GLB goes
    through :func:`read_glb`: trimesh's knows no sparse and no normalized arrays. The rest goes through ``trimesh.load``
    without processing, so that nothing is merged. PLY and GLB repeat vertices along the seams of a texture, STL at
    every triangle; :func:`toongeo.rig_mesh` can take them for one (``weld=True``).

    Parameters
    ----------
    path
        ``.obj``, ``.ply``, ``.stl``, ``.off`` or ``.glb``.

    Returns
    -------
    Scene
        In the unit and axes of the file (a GLB's are metres, +Y up), unlike the scenes that writers take. A GLB has a
        mesh for each that it shows, where its nodes put it; other files have one. Polygons are cut into triangles. Of
        a GLB the normals and of its materials the base colour are kept; bones, targets, animations and colours of
        vertices are not.

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If the suffix is another, the file is damaged, has no triangles, its numbers are not finite, or a GLB requires
        an extension that is not known here.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "t.off"
    >>> _ = path.write_text("OFF\\n3 1 0\\n0 0 0\\n1 0 0\\n0 1 0\\n3 0 1 2\\n")
    >>> read_mesh(path).meshes[0].faces
    array([[0, 1, 2]])
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in MESH_SUFFIXES:
        raise ValueError(f"path: expected a name that ends in {', '.join(MESH_SUFFIXES)}, got {path}")
    if suffix == ".obj":
        return _obj_scene(path)
    try:
        meshes = _glb_meshes(path) if suffix == ".glb" else _meshes(file_bytes(path), suffix[1:])
    except ImportError as error:  # a text that is no mesh is taken for a kind that needs a package
        raise ValueError(f"path: expected a mesh file, but {path} is damaged or none ({error})") from error
    if not meshes:
        raise ValueError(f"path: expected a mesh with triangles, got none in {path}")
    return Scene(tuple(meshes))


def _obj_scene(path: Path) -> Scene:
    read = read_obj(path)
    faces, uv_faces, _ = read.triangles()
    if len(read.uv) and (uv_faces >= 0).all():
        return Scene((SceneMesh("mesh", read.vertices, faces, uv=read.uv, uv_faces=uv_faces),))
    return Scene((SceneMesh("mesh", read.vertices, faces),))


def _glb_meshes(path: Path) -> list[SceneMesh]:
    document = read_glb(path)
    strange = [name for name in document.json.get("extensionsRequired", []) if not _KNOWN.match(name)]
    if strange:
        raise ValueError(f"path: expected a GLB that plain readers understand, but {path} requires {strange[0]}")
    return glb_meshes(document)


def _meshes(content: bytes, kind: str) -> list[SceneMesh]:
    import trimesh  # only here: it takes longer to import than an OBJ to read

    # From memory, so that a file cannot name others to be opened; of a picture that is named trimesh shows a traceback.
    log = trimesh.util.log
    before, log.disabled = log.disabled, True
    try:
        scene = trimesh.load_scene(BytesIO(content), file_type=kind, process=False)
    finally:
        log.disabled = before
    geometries = [(name, mesh) for name, mesh in scene.geometry.items() if isinstance(mesh, trimesh.Trimesh)]
    return [_scene_mesh(mesh, name) for name, mesh in geometries if len(mesh.faces)]


def _scene_mesh(mesh: trimesh.Trimesh, name: str) -> SceneMesh:
    uv = getattr(mesh.visual, "uv", None)
    picture = getattr(getattr(mesh.visual, "material", None), "image", None)
    return SceneMesh(
        name=name,
        vertices=np.array(mesh.vertices, np.float64),
        faces=np.array(mesh.faces, np.int64),
        uv=None if uv is None else np.array(uv, np.float64)[:, :2],
        texture=None if uv is None or picture is None else np.array(picture.convert("RGB")),
    )
