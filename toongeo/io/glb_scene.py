"""The scene that a GLB of ours holds."""

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from toongeo.io.encode_glb import METRES
from toongeo.io.read_glb import GlbDocument
from toongeo.io.scene import Scene, SceneAnimation, SceneMesh

__all__ = ["glb_scene"]


def glb_scene(document: GlbDocument) -> Scene:
    """Inverse of :func:`encode_glb`, up to float32 and up to the vertices repeated along uv seams.

    Encoding the result again (with the tolerance 0) gives the same bytes.

    Parameters
    ----------
    document
        From :func:`read_glb`; a primitive a mesh, a node a mesh, at most one animation.

    Returns
    -------
    Scene
        mm, model frame.

    Raises
    ------
    ValueError
        If a node holds no mesh or is scaled, turned or nested, or a mesh has several primitives.
    """
    textures: dict[int, NDArray[np.uint8]] = {}
    return Scene(
        tuple(_mesh(document, node, textures) for node in document.json.get("nodes", [])),
        _animation(document),
    )


def _mesh(document: GlbDocument, node: dict[str, Any], textures: dict[int, NDArray[np.uint8]]) -> SceneMesh:
    unknown = set(node) - {"name", "mesh", "translation"}
    if "mesh" not in node or unknown:
        raise ValueError(f"document: expected nodes of a mesh and a translation, got {node}")
    mesh = document.json["meshes"][node["mesh"]]
    if len(mesh["primitives"]) != 1:
        raise ValueError(f"document: expected one primitive a mesh, got {len(mesh['primitives'])}")
    primitive = mesh["primitives"][0]
    attributes = {name: document.accessors[index] for name, index in primitive["attributes"].items()}
    pivot = np.array(node["translation"]) / METRES if "translation" in node else None
    vertices = attributes["POSITION"].astype(np.float64) / METRES
    targets = [document.accessors[target["POSITION"]] for target in primitive.get("targets", [])]
    material = document.json["materials"][primitive["material"]]["pbrMetallicRoughness"]
    linear = np.array(material["baseColorFactor"][:3])
    uv = attributes.get("TEXCOORD_0")
    return SceneMesh(
        name=node["name"],
        vertices=vertices if pivot is None else vertices + pivot,
        faces=document.accessors[primitive["indices"]].reshape(-1, 3),
        uv=None if uv is None else uv.astype(np.float64) * [1, -1] + [0, 1],
        normals=attributes["NORMAL"],
        texture=_texture(document, material, textures),
        color=tuple(np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)),
        roughness=material["roughnessFactor"],
        targets=np.stack(targets).astype(np.float64) / METRES if targets else None,
        target_names=tuple(mesh.get("extras", {}).get("targetNames", ())),
        pivot=pivot,
    )


def _texture(
    document: GlbDocument, material: dict[str, Any], textures: dict[int, NDArray[np.uint8]]
) -> NDArray[np.uint8] | None:
    if "baseColorTexture" not in material:
        return None
    source = document.json["textures"][material["baseColorTexture"]["index"]]["source"]
    if source not in textures:
        textures[source] = np.array(Image.open(io.BytesIO(document.images[source])).convert("RGB"))
    return textures[source]


def _animation(document: GlbDocument) -> SceneAnimation | None:
    if "animations" not in document.json:
        return None
    animation = document.json["animations"][0]
    times = document.accessors[animation["samplers"][0]["input"]]
    tracks: dict[str, dict[str, NDArray]] = {"weights": {}, "rotation": {}}
    for channel in animation["channels"]:
        values = document.accessors[animation["samplers"][channel["sampler"]]["output"]]
        name = document.json["nodes"][channel["target"]["node"]]["name"]
        tracks[channel["target"]["path"]][name] = values.reshape(len(times), -1)
    return SceneAnimation(times, tracks["weights"], tracks["rotation"], animation["name"])
