"""The names under which an avatar's expressions, and its meshes, stand in a file."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal, get_args

from toongeo.avatar.scene import Shapes
from toongeo.io import Scene
from toongeo.model.expression_schemes import PRESETS, SCHEMES

__all__ = ["Names", "PLAYER_MESHES", "export_targets", "renamed_scene"]

Names = Literal["toongeo", "arkit", "talkinghead"]
# What players that speak by Oculus visemes look for, as in avatars of Ready Player Me: names of meshes, 15 visemes of
# which three have letters for names, and five mixtures.
PLAYER_MESHES = {
    "head": "Wolf3D_Head",
    "teeth": "Wolf3D_Teeth",
    "tongue": "Wolf3D_Tongue",
    "eye_left": "EyeLeft",
    "eye_right": "EyeRight",
    "hair": "Wolf3D_Hair",
    "neck_cap": "Wolf3D_Neck",
}
_LETTERS = {"ih": "I", "oh": "O", "ou": "U"}
_PLAYER_VISEMES = [(f"viseme_{_LETTERS.get(name, name)}", f"viseme_{name}") for name in SCHEMES["oculus"]]
_PLAYER_EXTRAS: Shapes = [
    ("mouthOpen", {"jawOpen": 1.0}),
    ("mouthSmile", {"mouthSmileLeft": 1.0, "mouthSmileRight": 1.0}),
    ("eyesClosed", {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}),
    ("eyesLookUp", {"eyeLookUpLeft": 1.0, "eyeLookUpRight": 1.0}),
    ("eyesLookDown", {"eyeLookDownLeft": 1.0, "eyeLookDownRight": 1.0}),
]


def export_targets(names: Names) -> Shapes | None:
    """Targets under the names that are asked for; None for the rig's own."""
    if names == "toongeo":
        return None
    if names == "arkit":
        return list(SCHEMES["arkit"].items())
    if names == "talkinghead":
        return [
            *SCHEMES["arkit"].items(),
            *((name, PRESETS[viseme]) for name, viseme in _PLAYER_VISEMES),
            *_PLAYER_EXTRAS,
        ]
    raise ValueError(f"names: expected one of {', '.join(get_args(Names))}, got {names!r}")


def renamed_scene(scene: Scene, names: Mapping[str, str]) -> Scene:
    """The same meshes under other names."""
    meshes = tuple(replace(mesh, name=names[mesh.name], parent=names.get(mesh.parent or "")) for mesh in scene.meshes)
    clip = scene.animation
    if clip is not None:
        clip = replace(clip, weights={names[mesh]: weights for mesh, weights in clip.weights.items()})
    return Scene(meshes, clip)
