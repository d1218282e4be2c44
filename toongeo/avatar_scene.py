"""An avatar as meshes with morph targets and a short clip, for the file writers."""

import numpy as np

from toongeo.crop_faces import Crop, crop_faces
from toongeo.geometry import vertex_normals
from toongeo.io import Scene, SceneAnimation, SceneMesh
from toongeo.model import MorphableModel
from toongeo.pipeline import Eyes, Rig
from toongeo.pipeline.rig.fit_eyes import SIDES
from toongeo.pipeline.rig.gaze import GAZE_NAMES, gaze_names

FRAMES_PER_SECOND = 30
# The clip: (seconds, weights reached then), linear in between.
CLIP: tuple[tuple[float, dict[str, float]], ...] = (
    (0.0, {}),
    (0.5, {}),
    (0.6, {"eyeBlinkLeft": 1, "eyeBlinkRight": 1}),
    (0.8, {}),
    (1.4, {"mouthSmileLeft": 1, "mouthSmileRight": 1, "cheekSquintLeft": 0.4, "cheekSquintRight": 0.4}),
    (2.0, {"eyeLookOutLeft": 0.8, "eyeLookInRight": 0.8, "mouthSmileLeft": 0.5, "mouthSmileRight": 0.5}),
    (2.6, {"eyeLookInLeft": 0.8, "eyeLookOutRight": 0.8, "browInnerUpLeft": 0.8, "browInnerUpRight": 0.8}),
    (3.2, {"jawOpen": 0.7, "browOuterUpLeft": 0.6, "browOuterUpRight": 0.6}),
    (3.8, {}),
)


def avatar_scene(rig: Rig, eyes: Eyes, model: MorphableModel, texture: np.ndarray, *, crop: Crop = "head") -> Scene:
    """Head and eyeballs of an avatar, and a clip that shows that they move.

    The head has the expressions of the rig and the ``eyeLook*`` directions as targets; each eyeball is a mesh of its
    own about its centre and has the four ``eyeLook*`` directions of its side.

    Parameters
    ----------
    rig : Rig
    eyes : Eyes
    model : MorphableModel
        For triangles and texture coordinates.
    texture : (size, size, 3) uint8 RGB
    crop : {"head", "bust", "face"}
        As of :func:`crop_faces`; vertices that no triangle needs are left out.

    Returns
    -------
    Scene
        Meshes ``head``, ``eye_left`` and ``eye_right``, which share one texture.
    """
    kept = crop_faces(model, crop)
    shapes = np.concatenate([rig.deltas, rig.gaze])
    used, faces = np.unique(model.faces[kept], return_inverse=True)
    used_uv, uv_faces = np.unique(model.uv_faces[kept], return_inverse=True)
    whole = len(used) == len(rig.neutral)
    head = SceneMesh(
        name="head",
        vertices=rig.neutral[used],
        faces=faces.reshape(-1, 3),
        uv=model.uv[used_uv],
        uv_faces=uv_faces.reshape(-1, 3),
        # A cut-out face is shaded like the whole head: its own normals would turn at the cut.
        normals=None if whole else vertex_normals(rig.neutral, model.faces)[used],
        texture=texture,
        targets=shapes if whole else shapes[:, used],
        target_names=(*rig.names, *GAZE_NAMES),
    )
    meshes = (head, *(_eye_mesh(eyes, side, texture) for side in (0, 1)))
    return Scene(meshes, _clip(meshes))


def _eye_mesh(eyes: Eyes, side: int, texture: np.ndarray) -> SceneMesh:
    eye, names = eyes.templates[side], gaze_names(SIDES[side])
    rest = eyes.vertices(side)
    return SceneMesh(
        name=f"eye_{SIDES[side]}",
        vertices=rest,
        faces=eye.faces,
        uv=eye.uv,
        normals=eye.vertices,
        texture=texture,
        roughness=0.25,
        targets=np.stack([eyes.looking(side, {name: 1.0}) - rest for name in names]),
        target_names=names,
        pivot=eyes.centres[side],
    )


def _clip(meshes: tuple[SceneMesh, ...]) -> SceneAnimation:
    keys = np.array([seconds for seconds, _ in CLIP])
    times = np.arange(round(keys[-1] * FRAMES_PER_SECOND) + 1) / FRAMES_PER_SECOND
    weights = {}
    for mesh in meshes:
        at_keys = np.array([[weights_then.get(name, 0.0) for name in mesh.target_names] for _, weights_then in CLIP])
        columns = [np.interp(times, keys, column) for column in at_keys.T]
        weights[mesh.name] = np.column_stack(columns)
    return SceneAnimation(times, weights, name="demo")
