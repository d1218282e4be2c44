"""An avatar with an expression, as meshes of trimesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from toongeo.avatar.crop_faces import Crop
from toongeo.avatar.scene import avatar_scene, head_parts
from toongeo.avatar.stages import AvatarStages
from toongeo.geometry import vertex_normals
from toongeo.io import Scene, trimesh_scene
from toongeo.model.anatomy.parts import SIDES

if TYPE_CHECKING:
    import trimesh

__all__ = ["avatar_trimesh"]


def avatar_trimesh(
    avatar: AvatarStages, head: np.ndarray, eyes: Sequence[np.ndarray], *, crop: Crop = "head", textured: bool = True
) -> trimesh.Scene:
    """What :meth:`toongeo.Avatar.to_trimesh` gives, for vertices of the head (n, 3) and of the eyeballs (k, 3), mm."""
    model = avatar.face.model
    normals = vertex_normals(head, model.faces)
    posed = {}
    for name, kept in head_parts(model, crop).items():
        used = np.unique(model.faces[kept])
        posed[name] = {"vertices": head[used], "normals": normals[used]}
    eyeballs = {f"eye_{side}": V for side, V in zip(SIDES, eyes, strict=False)}
    meshes = []
    for mesh in avatar_scene(avatar, crop=crop).meshes:
        if mesh.name == "neck_cap":  # for viewers; who counts triangles counts those of the model
            continue
        moved = posed.get(mesh.name, {})  # hair is rigid on the skull
        if mesh.name in eyeballs:
            moved = {"vertices": eyeballs[mesh.name], "normals": None}
        meshes.append(replace(mesh, **moved, targets=None, target_names=()))
    return trimesh_scene(Scene(tuple(meshes)), textured=textured)
