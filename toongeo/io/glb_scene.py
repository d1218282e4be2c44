"""The scene that a GLB of ours holds."""

import io
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from toongeo.colour.srgb import linear_to_srgb
from toongeo.io.gltf.scene_parts import NECK, NECK_REST
from toongeo.io.readers.read_glb import GlbDocument
from toongeo.io.scene import METRES, Scene, SceneAnimation, SceneMesh

__all__ = ["glb_scene"]


def glb_scene(document: GlbDocument) -> Scene:
    """Inverse of :func:`encode_glb`, up to float32 and up to the vertices repeated along uv seams.

    Encoding the result again (with the tolerance 0) gives the same bytes, if nothing was quantized.

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
        If a node holds no mesh or is turned, nested twice or scaled by axis, a mesh has several primitives, or
        anything else is not as :func:`encode_glb` writes it.
    """
    textures: dict[int, NDArray[np.uint8]] = {}
    try:
        with np.errstate(all="ignore"):  # numbers that are no longer finite are refused by the scene
            nodes = document.json.get("nodes", [])
            above = {child: node for node in nodes if not _of_neck(node) for child in node.get("children", [])}
            hung = [(k, node) for k, node in enumerate(nodes) if not _of_neck(node)]
            meshes = [_mesh(document, node, above.get(k), textures) for k, node in hung]
        return Scene(tuple(meshes), _animation(document))
    except (LookupError, TypeError, AttributeError, ArithmeticError, OSError) as error:  # OSError: of the picture
        reason = f"{type(error).__name__}: {error}"[:200]
        raise ValueError(f"document: expected a GLB as toongeo writes it, got another ({reason})") from error


def _of_neck(node: dict[str, Any]) -> bool:
    """Whether a node is one of those about which all others turn."""
    return "mesh" not in node and node.get("name") in (NECK, NECK_REST)


def _mesh(
    document: GlbDocument,
    node: dict[str, Any],
    above: dict[str, Any] | None,
    textures: dict[int, NDArray[np.uint8]],
) -> SceneMesh:
    unknown = set(node) - {"name", "mesh", "translation", "scale", "children"}
    scale = set(node.get("scale", [1.0]))
    if "mesh" not in node or unknown or len(scale) != 1 or (above is not None and "translation" in above):
        raise ValueError(f"document: expected nodes of a mesh, a translation and one scale, got {str(node)[:200]}")
    mesh = document.json["meshes"][node["mesh"]]
    if len(mesh["primitives"]) != 1:
        raise ValueError(f"document: expected one primitive a mesh, got {len(mesh['primitives'])}")
    primitive = mesh["primitives"][0]
    attributes = {name: _numbers(document, index) for name, index in primitive["attributes"].items()}
    normals = attributes["NORMAL"]
    pivot = np.array(node["translation"]) / METRES if "translation" in node else None
    millimetres = scale.pop() * (1.0 if above is None else above.get("scale", [1.0])[0]) / METRES
    vertices = attributes["POSITION"].astype(np.float64) * millimetres
    targets = [_numbers(document, target["POSITION"]) for target in primitive.get("targets", [])]
    look = document.json["materials"][primitive["material"]]
    material = look["pbrMetallicRoughness"]
    linear = np.array(material["baseColorFactor"][:3])
    uv = attributes.get("TEXCOORD_0")
    return SceneMesh(
        name=node["name"],
        vertices=vertices if pivot is None else vertices + pivot,
        faces=document.accessors[primitive["indices"]].reshape(-1, 3),
        uv=None if uv is None else uv.astype(np.float64) * [1, -1] + [0, 1],
        # Integers do not quite give unit length.
        normals=normals if normals.dtype == np.float32 else normals / np.linalg.norm(normals, axis=1, keepdims=True),
        texture=_texture(document, material, textures),
        color=tuple(linear_to_srgb(linear)),
        roughness=material["roughnessFactor"],
        specular=look.get("extensions", {}).get("KHR_materials_specular", {}).get("specularFactor", 1.0),
        unlit="KHR_materials_unlit" in look.get("extensions", {}),
        targets=np.stack(targets).astype(np.float64) * millimetres if targets else None,
        target_names=tuple(mesh.get("extras", {}).get("targetNames", ())),
        pivot=pivot,
        double_sided=look.get("doubleSided", False),
        parent=None if above is None else above["name"],
    )


def _numbers(document: GlbDocument, index: int) -> NDArray:
    """An accessor; integers that stand for fractions of 1 as these fractions (3.6.2.2)."""
    array = document.accessors[index]
    if not document.json["accessors"][index].get("normalized", False):
        return array
    return np.maximum(array / float(np.iinfo(array.dtype).max), -1.0)


def _texture(
    document: GlbDocument, material: dict[str, Any], textures: dict[int, NDArray[np.uint8]]
) -> NDArray[np.uint8] | None:
    if "baseColorTexture" not in material:
        return None
    source = document.json["textures"][material["baseColorTexture"]["index"]]["source"]
    if source not in textures:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            try:
                picture = Image.open(io.BytesIO(document.images[source]))
                textures[source] = np.array(picture.convert("RGB"))
            except (Image.DecompressionBombWarning, Image.DecompressionBombError, SyntaxError) as error:
                raise ValueError(f"document: picture {source} cannot be read ({error})") from error
    return textures[source]


def _animation(document: GlbDocument) -> SceneAnimation | None:
    if "animations" not in document.json:
        return None
    animation = document.json["animations"][0]
    times = document.accessors[animation["samplers"][0]["input"]]
    tracks: dict[str, dict[str, NDArray]] = {"weights": {}, "rotation": {}}
    nodes = document.json["nodes"]
    for channel in animation["channels"]:
        values = document.accessors[animation["samplers"][channel["sampler"]]["output"]]
        name = nodes[channel["target"]["node"]]["name"]
        tracks[channel["target"]["path"]][name] = values.reshape(len(times), -1)
    turns = tracks["rotation"].pop(NECK, None) if any(map(_of_neck, nodes)) else None
    places = [np.array(node["translation"]) / METRES for node in nodes if _of_neck(node) and node["name"] == NECK]
    neck = None if turns is None else places[0]
    return SceneAnimation(times, tracks["weights"], tracks["rotation"], animation["name"], turns, neck)
