"""Meshes for trimesh, and for all that builds on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from toongeo.colour.srgb import srgb_to_linear
from toongeo.geometry import vertex_normals
from toongeo.io.scene import Scene, SceneMesh
from toongeo.io.split_seams import split_seams

if TYPE_CHECKING:
    import trimesh

__all__ = ["trimesh_scene"]


def trimesh_scene(scene: Scene, *, textured: bool = True) -> trimesh.Scene:
    """The meshes of a scene, without targets and animation, as ``trimesh.Trimesh`` objects.

    Parameters
    ----------
    scene
        mm, model frame, as they stay.
    textured
        True: with texture coordinates and texture. As trimesh has one uv a vertex, vertices on seams are repeated.
        False: vertices and triangles alone, numbered as in `scene`.

    Returns
    -------
    trimesh.Scene
        Geometry and nodes by the names of the meshes; ``units`` are millimetres, which ``convert_units("meters")``
        brings to what a GLB should have.

    Examples
    --------
    >>> mesh = SceneMesh("triangle", np.eye(3), np.array([[0, 1, 2]]))
    >>> trimesh_scene(Scene((mesh,))).geometry["triangle"].faces.tolist()
    [[0, 1, 2]]
    """
    import trimesh

    converted = trimesh.Scene()
    pictures: dict[int, Image.Image] = {}  # a texture of several meshes stays one
    for mesh in scene.meshes:
        made = _textured(mesh, pictures) if textured else _bare(mesh)
        made.units = "millimeters"
        converted.add_geometry(made, node_name=mesh.name, geom_name=mesh.name)
    return converted


def _bare(mesh: SceneMesh) -> trimesh.Trimesh:
    import trimesh

    return trimesh.Trimesh(np.array(mesh.vertices), np.array(mesh.faces), process=False)


def _textured(mesh: SceneMesh, pictures: dict[int, Image.Image]) -> trimesh.Trimesh:
    import trimesh

    material = trimesh.visual.material.PBRMaterial(
        name=mesh.name,
        baseColorFactor=[*srgb_to_linear(mesh.color).tolist(), 1.0],  # linear light, unlike its texture
        metallicFactor=0.0,
        roughnessFactor=float(mesh.roughness),
    )
    uv_faces = mesh.faces if mesh.uv is None or mesh.uv_faces is None else mesh.uv_faces
    vertex, corner, faces = split_seams(mesh.faces, uv_faces)
    # Without those of the whole surface every seam would show as a crease.
    normals = vertex_normals(mesh.vertices, mesh.faces) if mesh.normals is None else np.asarray(mesh.normals)
    if mesh.texture is not None:
        key = mesh.texture.__array_interface__["data"][0]
        material.baseColorTexture = pictures.setdefault(key, Image.fromarray(np.asarray(mesh.texture)))
    return trimesh.Trimesh(
        np.asarray(mesh.vertices)[vertex],
        faces,
        vertex_normals=normals[vertex],
        visual=trimesh.visual.TextureVisuals(
            uv=None if mesh.uv is None else np.asarray(mesh.uv)[corner], material=material
        ),
        process=False,
    )
