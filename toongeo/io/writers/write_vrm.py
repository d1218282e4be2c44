"""A scene of a head as VRM 1.0, with a body of bones alone."""

import csv
import os
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

from toongeo.io.atomic_write import atomic_write
from toongeo.io.gltf.glb_builder import VERTICES, GlbBuilder
from toongeo.io.gltf.scene_parts import GlbOptions, Picture, add_scene
from toongeo.io.scene import METRES, Scene
from toongeo.io.writers.vrm_meta import VrmMeta
from toongeo.io.writers.vrm_springs import followed_bones, spring_entry, spring_rows

__all__ = ["write_vrm"]

_EYES = {"leftEye": ("LeftEye", "eye_left"), "rightEye": ("RightEye", "eye_right")}
_GROUND_MM = 1580.0  # of a standing adult: from the ground to the eyes
# The names that VRM gives a meaning; all others are the user's own.
_PRESETS = (
    *(
        "happy",
        "angry",
        "sad",
        "relaxed",
        "surprised",
        "aa",
        "ih",
        "ou",
        "ee",
        "oh",
        "blink",
        "blinkLeft",
        "blinkRight",
    ),
    *("lookUp", "lookDown", "lookLeft", "lookRight", "neutral"),
)


# Of MToon: light from all sides counts alike, and nothing shines at the edges.
_EVEN = {"shadingToonyFactor": 0.9, "giEqualizationFactor": 1.0, "parametricRimColorFactor": [0.0, 0.0, 0.0]}
_EMOTIONS = ("happy", "angry", "sad", "relaxed", "surprised")
# Targets by the beginning of their names; a wide eye does not close in a blink, an open jaw opens further in a vowel.
_OVERRIDES = {
    "overrideBlink": ("eyeBlink", "eyeWide", "eyeSquint"),
    "overrideLookAt": ("eyeLook",),
    "overrideMouth": ("jawOpen", "mouthFunnel", "mouthPucker"),
}


def write_vrm(
    path: str | os.PathLike[str],
    scene: Scene,
    expressions: Mapping[str, Mapping[str, float]],
    *,
    meta: VrmMeta | None = None,
    gaze_degrees: tuple[float, float] = (30.0, 25.0),
    normal_deltas: bool = False,
    tolerance_mm: float = 1e-3,
    picture: Picture = "png",
) -> None:
    """Write a ``.vrm``: a GLB with the extension ``VRMC_vrm``; atomically, the same bytes for the same arguments.

    The bones that a humanoid must have are there, in T-pose where those of an adult of 1.7 m are, in metres, the
    ground at y = 0 and the face along +Z. All meshes are skinned to the head's bone, neck included; ``eye_left`` and
    ``eye_right`` to bones of their own at their pivots, which turn them. Meshes with ``springs``
    have the bones of these, which hang from the head's, swing, and stay out of their capsules (``VRMC_springBone``).
    Those that are unlit have MToon materials.

    Parameters
    ----------
    path
        File to write.
    scene
        Model frame, mm. Its animation is left out.
    expressions : name -> target -> weight
        By the names of VRM's presets (``happy``, ``aa``, ``blink``, ...), or others, which become custom ones. Every
        mesh that has a target moves with it.
    meta
        Licence; by default nothing is allowed to others.
    gaze_degrees
        How far the eyes turn sideways, and up and down, when the goal is at 90 degrees.
    normal_deltas, tolerance_mm, picture
        As of :func:`encode_glb`.

    Raises
    ------
    ValueError
        If an expression has a target that no mesh has, or the scene has no eyes with pivots.
    OSError
        If the path cannot be written; nothing half-written remains.
    """
    names = {mesh.name: number for number, mesh in enumerate(scene.meshes)}
    for _, eye in _EYES.values():
        if eye not in names or scene.meshes[names[eye]].pivot is None:
            raise ValueError(f"scene: expected a mesh {eye!r} with a pivot, got {', '.join(names)}")
    binds = {name: _binds(scene, name, weights) for name, weights in expressions.items()}
    builder = GlbBuilder()
    # Skins hold the places of bones, and what they move stands on its own.
    free = (replace(mesh, pivot=None, parent=None) for mesh in scene.meshes)
    # MToon tells all about the light; beside it no other such extension may stand.
    still = Scene(tuple(replace(mesh, unlit=False, specular=1.0) if mesh.unlit else mesh for mesh in free))
    add_scene(builder, still, GlbOptions(normal_deltas=normal_deltas, tolerance_mm=tolerance_mm, picture=picture))
    bones, nodes = _add_bones(builder, scene)
    head = _bones()["Head"][2]
    middle = np.mean([_pivot(scene, eye) for _, eye in _EYES.values()], axis=0)
    _add_toon(builder, scene)
    builder.use("VRMC_vrm")
    builder.json["extensions"] = {
        "VRMC_vrm": {
            "specVersion": "1.0",
            "meta": (meta or VrmMeta()).entry(),
            "humanoid": {"humanBones": {bone: {"node": node} for bone, node in bones.items()}},
            "expressions": {
                "preset": {name: entry for name, entry in binds.items() if name in _PRESETS},
                "custom": {name: entry for name, entry in binds.items() if name not in _PRESETS},
            },
            "lookAt": _look_at((middle - head) * METRES, *gaze_degrees),
        }
    }
    springs = spring_entry(scene, nodes, "Head", head)
    if springs is not None:
        builder.use("VRMC_springBone")
        builder.json["extensions"]["VRMC_springBone"] = springs
    atomic_write({path: builder.encode()})


def _add_toon(builder: GlbBuilder, scene: Scene) -> None:
    """MToon for what is unlit: in the light and in its shade the same colours."""
    for mesh, material in zip(scene.meshes, builder.json["materials"], strict=True):
        if not mesh.unlit:
            continue
        base = material["pbrMetallicRoughness"]
        shade = {"shadeMultiplyTexture": base["baseColorTexture"]} if "baseColorTexture" in base else {}
        toon = {"specVersion": "1.0", "shadeColorFactor": base["baseColorFactor"][:3], **shade}
        material["extensions"] = {"VRMC_materials_mtoon": toon | _EVEN}
        builder.use("VRMC_materials_mtoon")


def _binds(scene: Scene, name: str, weights: Mapping[str, float]) -> dict[str, Any]:
    targets = {target for mesh in scene.meshes for target in mesh.target_names}
    for target in weights:
        if target not in targets:
            raise ValueError(f"expressions: expected targets of the scene in {name!r}, got {target!r}")
    binds = [
        {"node": node, "index": mesh.target_names.index(target), "weight": min(float(weight), 1.0)}
        for node, mesh in enumerate(scene.meshes)
        for target, weight in weights.items()
        if target in mesh.target_names
    ]
    entry: dict[str, Any] = {"morphTargetBinds": binds} if binds else {}
    return entry | {"isBinary": False} | {key: _override(name, weights, parts) for key, parts in _OVERRIDES.items()}


def _override(name: str, weights: Mapping[str, float], parts: tuple[str, ...]) -> str:
    """Whether an emotion takes the place of what moves the same parts: players add both otherwise."""
    moves = any(target.startswith(parts) for target, weight in weights.items() if weight)
    return "blend" if name in _EMOTIONS and moves else "none"


def _look_at(offset: NDArray[np.floating], sideways: float, updown: float) -> dict[str, Any]:
    def reach(degrees: float) -> dict[str, float]:
        return {"inputMaxValue": 90.0, "outputScale": float(degrees)}

    return {
        "type": "bone",
        "offsetFromHeadBone": offset.tolist(),
        "rangeMapHorizontalInner": reach(sideways),
        "rangeMapHorizontalOuter": reach(sideways),
        "rangeMapVerticalDown": reach(updown),
        "rangeMapVerticalUp": reach(updown),
    }


def _add_bones(builder: GlbBuilder, scene: Scene) -> tuple[dict[str, int], dict[str, int]]:
    """The bones, and the skin of the meshes, whose nodes are the first; the node of each by VRM's name, and by ours."""
    nodes = builder.json["nodes"]
    places: dict[str, NDArray[np.floating]] = {}
    by_name, humanoid = {}, {}
    rows: list[tuple[str, str, str, NDArray[np.floating]]] = [(name, *row) for name, row in _bones().items()]
    rows += [(name, bone, "Head", _pivot(scene, eye)) for bone, (name, eye) in _EYES.items()]
    rows += spring_rows(scene, "Head")
    for name, bone, parent, place in rows:
        above = places.get(parent, np.array([0.0, -_GROUND_MM, 0.0]))
        index = builder.add("nodes", name=name, translation=((place - above) * METRES).tolist())
        places[name], by_name[name] = place, index
        if bone:
            humanoid[bone] = index
        if parent:
            nodes[by_name[parent]].setdefault("children", []).append(index)
    builder.json["scenes"] = [{"nodes": [*range(len(scene.meshes)), by_name["Hips"]]}]
    _add_skin(builder, scene, places, by_name)
    return humanoid, by_name


def _add_skin(
    builder: GlbBuilder, scene: Scene, places: dict[str, NDArray[np.floating]], nodes: dict[str, int]
) -> None:
    """An eyeball follows the bone of its eye, all else that of the head; what swings, its chains as well."""
    inverse = np.tile(np.eye(4, dtype="<f4"), (len(places), 1, 1))
    inverse[:, 3, :3] = -np.array(list(places.values())) * METRES  # a row is a column of the matrix in the file
    matrices = builder.accessor(inverse.reshape(-1, 16))
    skin = builder.add("skins", inverseBindMatrices=matrices, joints=[nodes[name] for name in places])
    hanging = {eye: name for name, eye in _EYES.values()}
    order = {name: number for number, name in enumerate(places)}
    for node, mesh in enumerate(scene.meshes):
        attributes = builder.json["meshes"][node]["primitives"][0]["attributes"]
        joints, weights = followed_bones(mesh, order, hanging.get(mesh.name, "Head"))
        attributes["JOINTS_0"] = builder.accessor(joints, VERTICES)
        attributes["WEIGHTS_0"] = builder.accessor(weights, VERTICES, normalized=True)
        builder.json["nodes"][node]["skin"] = skin


def _pivot(scene: Scene, name: str) -> NDArray[np.floating]:
    (pivot,) = (mesh.pivot for mesh in scene.meshes if mesh.name == name)
    assert pivot is not None
    return pivot


@cache
def _bones() -> dict[str, tuple[str, str, NDArray[np.float64]]]:
    """VRM's name, parent and place (3,), mm, of each bone."""
    text = files("toongeo.io").joinpath("humanoid_bones.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    return {row["name"]: (row["bone"], row["parent"], np.array([float(row[axis]) for axis in "xyz"])) for row in rows}
