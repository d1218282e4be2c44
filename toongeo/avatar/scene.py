"""An avatar as meshes with morph targets and a clip, for the file writers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from toongeo.avatar.crop_faces import Crop, crop_faces
from toongeo.avatar.hair_springs import hair_springs
from toongeo.avatar.looks.neck_cap import neck_cap
from toongeo.avatar.looks.uv_colours import uv_colours
from toongeo.avatar.stages import AvatarStages
from toongeo.geometry import vertex_normals
from toongeo.io import Scene, SceneAnimation, SceneMesh
from toongeo.model import MorphableModel, atlas_coordinates
from toongeo.model.anatomy.gaze import GAZE_NAMES, gaze_names
from toongeo.model.anatomy.parts import SIDES, TEETH
from toongeo.pipeline import AlignedFace, Eyes, Hair, Rig
from toongeo.render import Surface

__all__ = ["Shapes", "avatar_scene", "head_parts", "own_shapes"]

# Parts of the head that are meshes of their own, by regions of the model; the rest is the mesh "head".
_PARTS = {"teeth": TEETH, "tongue": ("tongue",)}
_ROUGHNESS, _SPECULAR = 1.0, 0.2  # of skin in soft light; chosen by eye on the astronaut in three.js
_STILL_MM = 1e-4  # a target that moves no vertex of a part by more is not among the part's
Shapes = Sequence[tuple[str, Mapping[str, float]]]


def avatar_scene(
    avatar: AvatarStages,
    *,
    crop: Crop = "head",
    shapes: Shapes | None = None,
    animation: SceneAnimation | None = None,
    textured: bool = True,
    split: bool = True,
    unlit: bool = False,
) -> Scene:
    """Head, teeth, tongue, eyeballs and hair of an avatar.

    The mesh ``head`` (the skin, with what lies in mouth and sockets) has every target; the others have those that move
    them. Each eyeball is about its centre.

    Parameters
    ----------
    avatar : AvatarStages
        For example an :class:`toongeo.Avatar`.
    crop : {"head", "bust", "face"}
        As of :func:`crop_faces`; vertices that no triangle needs are left out.
    shapes : pairs of a name and weights, optional
        Targets: their names in the file, and the weights of the rig's expressions and ``eyeLook*`` names that make
        them. By default those of the rig under their own names.
    animation : SceneAnimation, optional
        Its only track is ``"head"``, (f, 46 + 8): weights of the rig in its order, as `demo_clip` makes one.
    textured : bool
        False: every mesh has the mean of its texture as its colour.
    split : bool
        False: teeth and tongue stay in the head, whose vertices keep their numbers unless it is cropped.
    unlit : bool
        Whether colours are shown as they are.

    Returns
    -------
    Scene
        Meshes ``head``, ``teeth``, ``tongue``, ``eye_left`` and ``eye_right``, which share one texture, and ``hair``
        with its own, on the head, unless there is none or the crop is "face"; and ``neck_cap``, which closes the
        neck. A model without the regions of teeth and tongue has them in the head.
    """
    shapes = own_shapes(avatar.rig) if shapes is None else shapes
    model = avatar.face.model
    parts = head_parts(model, crop) if split else {"head": crop_faces(model, crop)}
    meshes = [_part(avatar, name, faces, shapes, crop) for name, faces in parts.items()]
    meshes += [_eye(avatar.eyes, side, avatar.texture, shapes) for side in range(len(avatar.eyes.templates))]
    if avatar.hair is not None and crop != "face":
        meshes.append(_hair(avatar.hair, avatar.face))
    cap = neck_cap(model, avatar.rig, avatar.texture)
    if cap is not None and crop != "face":
        meshes.append(_cap(cap))
    # The picture's own highlights and shadows are in its texture: a second gloss over them would bleach it.
    meshes = [replace(mesh, roughness=_ROUGHNESS, specular=_SPECULAR, unlit=unlit) for mesh in meshes]
    clip = None if animation is None else _tracks(avatar.rig, animation, shapes, meshes)
    return Scene(tuple(meshes if textured else map(_plain, meshes)), clip)


def own_shapes(rig: Rig) -> Shapes:
    """Every expression of a rig and every direction of gaze under its own name."""
    return [(name, {name: 1.0}) for name in (*rig.names, *GAZE_NAMES)]


def head_parts(model: MorphableModel, crop: Crop = "head") -> dict[str, np.ndarray]:
    """Rows of ``model.faces`` that each mesh of the head has; parts without triangles are left out."""
    kept = crop_faces(model, crop)
    rest, parts = np.ones(len(kept), bool), {}
    for name, regions in _PARTS.items():
        inside = np.any([model.region(region) for region in regions], axis=0)[model.faces[kept]].all(axis=1)
        parts[name] = kept[inside]
        rest &= ~inside
    return {name: faces for name, faces in {"head": kept[rest], **parts}.items() if len(faces)}


def _part(avatar: AvatarStages, name: str, kept: np.ndarray, shapes: Shapes, crop: Crop) -> SceneMesh:
    rig, model = avatar.rig, avatar.face.model
    used, faces = np.unique(model.faces[kept], return_inverse=True)
    atlas = atlas_coordinates(model)
    used_uv, uv_faces = np.unique(atlas.uv_faces[kept], return_inverse=True)
    targets = np.stack([_delta(rig, weights, used) for _, weights in shapes])
    moving = np.full(len(shapes), True) if name == "head" else np.abs(targets).max(axis=(1, 2)) > _STILL_MM
    return SceneMesh(
        name=name,
        vertices=rig.neutral[used],
        faces=faces.reshape(-1, 3),
        uv=atlas.uv[used_uv],
        uv_faces=uv_faces.reshape(-1, 3),
        # A cut-out face is shaded like the whole head: its own normals would turn at the cut.
        normals=vertex_normals(rig.neutral, model.faces)[used] if crop == "face" else None,
        texture=avatar.texture,
        targets=targets[moving] if moving.any() else None,
        target_names=tuple(shape for (shape, _), moves in zip(shapes, moving, strict=True) if moves),
    )


def _delta(rig: Rig, weights: Mapping[str, float], used: np.ndarray) -> np.ndarray:
    """What the weights add to the used vertices, mm; expressions that the rig does not have add nothing."""
    delta = np.zeros((len(used), 3), np.float32)
    for name, weight in weights.items():
        gaze = name in GAZE_NAMES
        if gaze or name in rig.names:
            shape = rig.gaze[GAZE_NAMES.index(name)] if gaze else rig.deltas[rig.names.index(name)]
            delta += np.float32(weight) * shape[used]
    return delta


def _eye(eyes: Eyes, side: int, texture: np.ndarray, shapes: Shapes) -> SceneMesh:
    eye, rest = eyes.templates[side], eyes.vertices(side)
    looks = {name: {k: w for k, w in weights.items() if k in gaze_names(SIDES[side])} for name, weights in shapes}
    looks = {name: weights for name, weights in looks.items() if weights}
    targets = [eyes.looking(side, weights) - rest for weights in looks.values()]
    return SceneMesh(
        name=f"eye_{SIDES[side]}",
        vertices=rest,
        faces=eye.faces,
        uv=eye.uv,
        normals=eye.vertices,
        texture=texture,
        targets=np.stack(targets) if targets else None,
        target_names=tuple(looks),
        pivot=eyes.centres[side],
    )


def _hair(hair: Hair, face: AlignedFace) -> SceneMesh:
    return SceneMesh(
        name="hair",
        vertices=hair.vertices,
        faces=hair.faces,
        uv=hair.uv,
        uv_faces=hair.uv_faces,
        texture=hair.texture,
        double_sided=True,
        parent="head",
        springs=hair_springs(hair, face),
    )


def _cap(cap: Surface) -> SceneMesh:
    assert cap.colours is not None
    red, green, blue = cap.colours[0].tolist()
    return SceneMesh("neck_cap", cap.vertices, cap.faces, color=(red, green, blue))


def _tracks(rig: Rig, animation: SceneAnimation, shapes: Shapes, meshes: list[SceneMesh]) -> SceneAnimation:
    """The weights of the rig as those of the meshes' targets.

    A target that is made of several expressions gets the mean of their weights: right for the halves of one. Each
    expression moves one target only, the first that has it with weight 1.
    """
    names, weights = [name for name, _ in own_shapes(rig)], animation.weights["head"]
    free, tracks = set(names), {}
    for shape, mix in shapes:
        if mix and set(mix) <= free and all(weight == 1.0 for weight in mix.values()):
            tracks[shape] = weights[:, [names.index(name) for name in mix]].mean(axis=1)
            free -= set(mix)
    still = np.zeros(len(weights))
    by_mesh = {
        mesh.name: np.column_stack([tracks.get(name, still) for name in mesh.target_names])
        for mesh in meshes
        if mesh.target_names
    }
    return replace(animation, weights=by_mesh)


def _plain(mesh: SceneMesh) -> SceneMesh:
    """A mesh in the mean colour that its texture has at its vertices."""
    if mesh.texture is None:
        return mesh
    red, green, blue = (uv_colours(mesh).mean(axis=0) / 255).tolist()
    return replace(mesh, texture=None, color=(red, green, blue))
