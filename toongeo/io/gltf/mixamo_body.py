"""The bones of a body for a head that has none, as players of talking heads ask for them."""

import csv
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from toongeo.io.gltf.glb_builder import INDICES, VERTICES, GlbBuilder
from toongeo.io.scene import METRES, Scene

__all__ = ["BODY_ROOT", "add_mixamo_body"]

BODY_ROOT = "Armature"
_EYES = {"LeftEye": "EyeLeft", "RightEye": "EyeRight"}  # bones, and the meshes in whose middle they stand
_HEAD_MM = np.array([0.0, -85.0, -80.0])  # the bone, model frame: as in humanoid_bones.csv
_SPECK = 1e-6  # m: side of the triangle on the ground, which no picture shows


class _Bone(NamedTuple):
    name: str
    parent: str
    place: NDArray[np.float64]
    turn: list[float] | None


def add_mixamo_body(builder: GlbBuilder, scene: Scene) -> None:
    """Hang the meshes of a scene, whose nodes are the first, from the head of a body of 67 bones.

    Above all stands the node ``Armature``, on the ground. Players put the lowest point of what is below it there,
    which would sink a head without a body: a triangle too small to be seen gives them a ground.

    Parameters
    ----------
    builder
        To which ``add_scene`` has added the scene.
    scene
        Model frame, mm. Meshes ``EyeLeft`` and ``EyeRight`` tell where the bones of the eyes are.
    """
    nodes, tops = builder.json["nodes"], builder.json["scenes"][0]["nodes"]
    for top in tops:
        local = np.array(nodes[top].get("translation", [0.0, 0.0, 0.0])) - _HEAD_MM * METRES
        nodes[top]["translation"] = local.tolist()
    pivots = {mesh.name: mesh.pivot for mesh in scene.meshes}
    number: dict[str, int] = {}
    for bone in _bones():
        eye = pivots.get(_EYES.get(bone.name, ""))
        place = bone.place if eye is None else eye - _HEAD_MM
        number[bone.name] = builder.add(
            "nodes", name=bone.name, translation=(place * METRES).tolist(), rotation=bone.turn
        )
        if bone.parent:
            nodes[number[bone.parent]].setdefault("children", []).append(number[bone.name])
    nodes[number["Head"]]["children"] += tops
    ground = builder.add("nodes", name="Ground", mesh=_speck(builder))
    root = builder.add("nodes", name=BODY_ROOT, children=[number["Hips"], ground])
    builder.json["scenes"] = [{"nodes": [root]}]


def _speck(builder: GlbBuilder) -> int:
    corners = np.array([[0, 0, 0], [0, 0, _SPECK], [_SPECK, 0, 0]], "<f4")
    up = np.tile(np.array([0, 1, 0], "<f4"), (3, 1))
    attributes = {
        "POSITION": builder.accessor(corners, VERTICES, bounds=True),
        "NORMAL": builder.accessor(up, VERTICES),
    }
    indices = builder.accessor(np.arange(3, dtype="<u2"), INDICES)
    return builder.add("meshes", name="Ground", primitives=[{"attributes": attributes, "indices": indices}])


@cache
def _bones() -> list[_Bone]:
    text = files("toongeo.io").joinpath("mixamo_bones.csv").read_text(encoding="utf-8")
    rows: list[dict[str, Any]] = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    return [
        _Bone(
            row["name"],
            row["parent"],
            np.array([float(row[axis]) for axis in "xyz"]),
            _quaternion(float(row["pitch"]), float(row["roll"])),
        )
        for row in rows
    ]


def _quaternion(pitch: float, roll: float) -> list[float] | None:
    """x, y, z, w of a turn about z and then about x, degrees; None if there is none."""
    if not pitch and not roll:
        return None
    (sx, sz), (cx, cz) = np.sin(np.radians([pitch, roll]) / 2), np.cos(np.radians([pitch, roll]) / 2)
    return [float(sx * cz), float(-sx * sz), float(cx * sz), float(cx * cz)]
