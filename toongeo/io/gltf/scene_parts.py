"""The meshes, materials and animation of a scene as entries of a GLB."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.colour.srgb import srgb_to_linear
from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.io.encode_image import encode_image
from toongeo.io.gltf.glb_builder import INDICES, VERTICES, GlbBuilder
from toongeo.io.gltf.glb_targets import add_targets
from toongeo.io.scene import METRES, Scene, SceneAnimation, SceneMesh
from toongeo.io.split_seams import split_seams

__all__ = ["NECK", "NECK_REST", "GlbOptions", "Picture", "add_scene"]

Picture = Literal["png", "jpeg"]
NECK, NECK_REST = "neck", "neck_rest"  # nodes above the meshes of a head that turns

_STEPS = 2048  # of the greatest coordinate, as which displacements are quantized: 0.09 mm of a head
_BYTE = 127  # what 1 is as a normalized integer of 8 bits
# Below this a change of a normal cannot be seen: 0.06 degrees.
_NORMAL_TOLERANCE = 1e-3
_BORDER = 1e-3  # of the picture: uv that are off by less are those of its border
_TRILINEAR = {"magFilter": 9729, "minFilter": 9987}
_CLAMPED, _REPEATED = 33071, 10497  # beyond the picture: its border goes on, or it begins again


@dataclass(frozen=True)
class GlbOptions:
    """Of :func:`encode_glb`."""

    normal_deltas: bool = False
    tolerance_mm: float = 1e-3
    quantize: bool = False
    picture: Picture = "png"
    sparse: bool = True


def add_scene(builder: GlbBuilder, scene: Scene, options: GlbOptions) -> None:
    """Add everything; meshes and nodes get the numbers that the meshes have in the scene."""
    textures: dict[bytes, int] = {}
    if options.quantize:
        builder.use("KHR_mesh_quantization", required=True)
    units = {mesh.name: _unit(mesh) if options.quantize else None for mesh in scene.meshes}
    for mesh in scene.meshes:
        unit = units[mesh.name]
        primitive = _primitive(builder, mesh, options, unit)
        primitive["material"] = _material(builder, mesh, textures, options.picture)
        k = len(mesh.target_names)
        index = builder.add(
            "meshes",
            name=mesh.name,
            primitives=[primitive],
            weights=[0.0] * k if k else None,
            extras={"targetNames": list(mesh.target_names)} if k else None,
        )
        pivot = None if mesh.pivot is None else (mesh.pivot * METRES).tolist()
        above = units.get(mesh.parent or "")
        size = None if unit is None else [unit * METRES if above is None else unit / above] * 3
        builder.add("nodes", name=mesh.name, mesh=index, translation=pivot, scale=size)
    names = [mesh.name for mesh in scene.meshes]
    for child, mesh in enumerate(scene.meshes):
        if mesh.parent is not None:
            builder.json["nodes"][names.index(mesh.parent)].setdefault("children", []).append(child)
    nodes = [node for node, mesh in enumerate(scene.meshes) if mesh.parent is None]
    clip = scene.animation
    if clip is not None and clip.neck is not None:
        # The inner node takes back what the outer one moved: the meshes' own nodes are as without a neck.
        place = np.asarray(clip.neck, np.float64) * METRES
        rest = builder.add("nodes", name=NECK_REST, translation=(-place).tolist(), children=nodes)
        nodes = [builder.add("nodes", name=NECK, translation=place.tolist(), children=[rest])]
        names += [NECK_REST, NECK]
    builder.json["scenes"] = [{"nodes": nodes}]
    builder.json["scene"] = 0
    if clip is not None:
        _animate(builder, clip, names)


def _local(mesh: SceneMesh) -> NDArray[np.floating]:
    return mesh.vertices if mesh.pivot is None else mesh.vertices - mesh.pivot


def _unit(mesh: SceneMesh) -> float:
    """mm that 1 is as an integer: small, so that none suffers, and so great that most displacements fit a byte."""
    local, targets = np.abs(_local(mesh)).max(), np.zeros(1) if mesh.targets is None else np.abs(mesh.targets)
    return float(max(local / _STEPS, targets.max(initial=0) / np.iinfo(np.int16).max)) or 1.0


def _primitive(builder: GlbBuilder, mesh: SceneMesh, options: GlbOptions, unit: float | None) -> dict[str, Any]:
    uv_faces = mesh.faces if mesh.uv_faces is None else mesh.uv_faces
    vertex, uv, faces = split_seams(mesh.faces, uv_faces)
    base = _normals(mesh.vertices, mesh.faces)
    normals = base if mesh.normals is None else mesh.normals
    whole, scale = unit is not None, METRES if unit is None else 1 / unit
    attributes = {
        "POSITION": builder.accessor(_f4(_local(mesh)[vertex] * scale), VERTICES, bounds=True),
        "NORMAL": builder.accessor(_normal(normals[vertex], whole), VERTICES, normalized=whole),
    }
    if mesh.uv is not None:
        # glTF's uv origin is the upper left corner.
        coordinates = mesh.uv[uv] * [1, -1] + [0, 1]
        small = whole and coordinates.min() >= 0 and coordinates.max() <= 1
        stored = np.rint(coordinates * 65535).astype("<u2") if small else _f4(coordinates)
        attributes["TEXCOORD_0"] = builder.accessor(stored, VERTICES, normalized=small)
    index_type = "<u2" if len(vertex) <= 65535 else "<u4"  # 65535 itself would restart the primitive
    primitive: dict[str, Any] = {
        "attributes": attributes,
        "indices": builder.accessor(faces.astype(index_type).ravel(), INDICES),
    }
    if mesh.target_names and mesh.targets is not None:
        tolerance = options.tolerance_mm * scale
        moved = mesh.targets[:, vertex] * scale
        moved = np.rint(moved).astype("<i2") if whole else _f4(moved)
        targets = [{"POSITION": i} for i in add_targets(builder, moved, tolerance, options.sparse, bounds=True)]
        if options.normal_deltas:
            turned = [(_normals(mesh.vertices + delta, mesh.faces) - base)[vertex] for delta in mesh.targets]
            stored = _normal(np.stack(turned), whole)
            tolerance = _NORMAL_TOLERANCE * (_BYTE if whole else 1)
            turns = add_targets(builder, stored, tolerance, options.sparse, normalized=whole)
            for entry, i in zip(targets, turns, strict=True):
                entry["NORMAL"] = i
        primitive["targets"] = targets
    return primitive


def _normal(array: NDArray[np.floating], whole: bool) -> NDArray:
    return np.rint(np.clip(array, -1, 1) * _BYTE).astype("<i1") if whole else _f4(array)


def _normals(V: NDArray[np.floating], F: NDArray[np.integer]) -> NDArray[np.float64]:
    """(n, 3), all of unit length as the format demands: +Z where the faces give none."""
    normals = vertex_normals(V, F)
    return np.where(normals.any(axis=1, keepdims=True), normals, [0.0, 0.0, 1.0])


def _material(builder: GlbBuilder, mesh: SceneMesh, textures: dict[bytes, int], picture: Picture) -> int:
    linear = srgb_to_linear(np.array(mesh.color, np.float64))  # factors are linear light, textures are sRGB
    look: dict[str, Any] = {
        "baseColorFactor": [*linear.tolist(), 1.0],
        "metallicFactor": 0.0,
        "roughnessFactor": float(mesh.roughness),
    }
    if mesh.texture is not None:
        tiled = mesh.uv is not None and bool((np.abs(mesh.uv - 0.5) > 0.5 + _BORDER).any())
        look["baseColorTexture"] = {"index": _texture(builder, mesh.texture, textures, picture, tiled=tiled)}
    both = True if mesh.double_sided else None
    extensions: dict[str, Any] = {}
    if mesh.unlit:
        extensions["KHR_materials_unlit"] = {}
    elif mesh.specular != 1.0:  # what is unlit mirrors nothing
        extensions["KHR_materials_specular"] = {"specularFactor": float(mesh.specular)}
    for extension in extensions:
        builder.use(extension)
    return builder.add(
        "materials", name=mesh.name, pbrMetallicRoughness=look, doubleSided=both, extensions=extensions or None
    )


def _texture(
    builder: GlbBuilder, pixels: NDArray[np.uint8], textures: dict[bytes, int], picture: Picture, *, tiled: bool
) -> int:
    """The picture, once for all meshes that have it; it repeats where uv leave 0..1, as those of tiles do."""
    key = str((pixels.shape, tiled)).encode() + pixels.tobytes()
    if key not in textures:
        wrap = _REPEATED if tiled else _CLAMPED
        sampler = _TRILINEAR | {"wrapS": wrap, "wrapT": wrap}
        samplers = builder.json.get("samplers", [])
        number = samplers.index(sampler) if sampler in samplers else builder.add("samplers", **sampler)
        view = builder.view(encode_image(pixels, f".{picture}"))
        image = builder.add("images", bufferView=view, mimeType=f"image/{picture}")
        textures[key] = builder.add("textures", source=image, sampler=number)
    return textures[key]


def _animate(builder: GlbBuilder, animation: SceneAnimation, names: list[str]) -> None:
    times = builder.accessor(_f4(animation.times), bounds=True)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    outputs = [(name, "weights", _f4(values).ravel()) for name, values in animation.weights.items()]
    outputs += [(name, "rotation", _f4(values)) for name, values in animation.rotations.items()]
    if animation.turns is not None:
        outputs.append((NECK, "rotation", _f4(animation.turns)))
    for name, path, values in outputs:
        channels.append({"sampler": len(samplers), "target": {"node": names.index(name), "path": path}})
        samplers.append({"input": times, "output": builder.accessor(values), "interpolation": "LINEAR"})
    if channels:
        builder.add("animations", name=animation.name, samplers=samplers, channels=channels)


def _f4(array: ArrayLike) -> NDArray[np.float32]:
    return np.ascontiguousarray(array, dtype="<f4")
