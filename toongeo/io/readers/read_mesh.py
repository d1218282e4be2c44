"""A mesh file of another program, by trimesh or by our reader of OBJ."""

from __future__ import annotations

import os
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from toongeo.arrays import Bytes, Floats
from toongeo.colour.srgb import linear_to_srgb
from toongeo.io.readers.read_glb import read_glb
from toongeo.io.readers.read_obj import read_obj
from toongeo.io.scene import Scene, SceneMesh
from toongeo.reading.check_file import file_bytes
from toongeo.reading.promise import promised

if TYPE_CHECKING:
    import trimesh

__all__ = ["MESH_SUFFIXES", "read_mesh"]

MESH_SUFFIXES = (".obj", ".ply", ".stl", ".off", ".glb")


@promised("a mesh file")
def read_mesh(path: str | os.PathLike[str]) -> Scene:
    """Read triangle meshes with their texture coordinates and textures, every vertex in its place in the file.

    OBJ goes through :func:`read_obj` and is one mesh: trimesh's reader repeats or reorders its vertices. All else goes
    through ``trimesh.load`` without processing, so that nothing is merged. PLY and GLB repeat vertices along the seams
    of a texture, STL at every triangle; :func:`toongeo.rig_mesh` can take them for one (``weld=True``).

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
        If the suffix is another, the file is damaged, has no triangles, or its numbers are not finite.

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
    content = file_bytes(path)
    if suffix == ".glb":
        read_glb(path)  # says what it is packed by, and bounds what it announces
    try:
        meshes = _meshes(content, suffix[1:])
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


def _meshes(content: bytes, kind: str) -> list[SceneMesh]:
    import trimesh  # only here: it takes longer to import than an OBJ to read

    # From memory, so that a file cannot name others to be opened.
    scene = trimesh.load_scene(BytesIO(content), file_type=kind, process=False)
    found = []
    for name, geometry in scene.geometry.items():
        if not isinstance(geometry, trimesh.Trimesh) or not len(geometry.faces):
            continue
        nodes = sorted(node for node in scene.graph.nodes_geometry if scene.graph[node][1] == name)
        for node in nodes:
            label = f"{name}.{node}" if len(nodes) > 1 else name
            found.append(_scene_mesh(geometry, scene.graph[node][0], label, keep_normals=kind == "glb"))
    return found


def _scene_mesh(mesh: trimesh.Trimesh, place: Floats, name: str, *, keep_normals: bool) -> SceneMesh:
    """A mesh where its node puts it; a mirror turns its triangles over."""
    vertices, faces = np.array(mesh.vertices, np.float64), np.array(mesh.faces, np.int64)
    if not np.array_equal(place, np.eye(4)):
        vertices = vertices @ place[:3, :3].T + place[:3, 3]
    if np.linalg.det(place[:3, :3]) < 0:
        faces = faces[:, ::-1]
    uv = getattr(mesh.visual, "uv", None)
    material = getattr(mesh.visual, "material", None)
    texture = None if uv is None else _texture(material)
    return SceneMesh(
        name=name,
        vertices=vertices,
        faces=faces,
        uv=None if uv is None else np.array(uv, np.float64)[:, :2],
        normals=_normals(mesh, place) if keep_normals else None,
        texture=texture,
        color=_color(material),
    )


def _normals(mesh: trimesh.Trimesh, place: Floats) -> Floats | None:
    """Those of the file, which know nothing of its seams; None if one has no direction."""
    normals = np.asarray(mesh.vertex_normals) @ np.linalg.inv(place[:3, :3])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / length if (length > 0).all() else None


def _texture(material: Any) -> Bytes | None:
    picture = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    return None if picture is None else np.array(picture.convert("RGB"))


def _color(material: Any) -> tuple[float, float, float]:
    factor = getattr(material, "baseColorFactor", None)
    if factor is None:
        return (1.0, 1.0, 1.0)
    red, green, blue = linear_to_srgb(np.asarray(factor, np.float64)[:3] / 255)  # trimesh keeps them as bytes
    return float(red), float(green), float(blue)
