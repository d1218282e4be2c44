"""A scene as the bytes of a binary glTF 2.0 file."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from toongeo.geometry.vertex_normals import vertex_normals
from toongeo.io._glb_builder import INDICES, VERTICES, GlbBuilder
from toongeo.io.encode_image import encode_image
from toongeo.io.scene import Scene, SceneAnimation, SceneMesh
from toongeo.io.split_seams import split_seams

__all__ = ["encode_glb"]

METRES = 1e-3  # glTF's unit in ours; its axes (+Y up, a face looks along +Z) are ours already
# Below this a change of a normal cannot be seen: 0.06 degrees.
_NORMAL_TOLERANCE = 1e-3
_SAMPLER = {"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}  # trilinear, clamped


def encode_glb(scene: Scene, *, normal_deltas: bool = False, tolerance_mm: float = 1e-3) -> bytes:
    """Binary glTF: a node a mesh, sparse float32 morph targets, embedded PNG textures, one animation.

    Written by hand because no Python library writes sparse morph targets that the Khronos validator
    accepts. Vertices are repeated along uv seams as by :func:`split_seams`; those in no face are left out.

    Parameters
    ----------
    scene
        Model frame, mm; the file is in metres, with the same axes.
    normal_deltas
        Whether the targets also bend the normals (doubles the file; viewers that compute normals need it
        not).
    tolerance_mm
        Displacements with no coordinate above this are not stored.

    Returns
    -------
    bytes
        The same for the same scene.

    Raises
    ------
    ValueError
        If ``tolerance_mm`` is negative.
    """
    if not tolerance_mm >= 0:
        raise ValueError(f"tolerance_mm: expected >= 0, got {tolerance_mm}")
    builder = GlbBuilder()
    textures: dict[bytes, int] = {}
    for mesh in scene.meshes:
        primitive = _primitive(builder, mesh, normal_deltas, tolerance_mm)
        primitive["material"] = _material(builder, mesh, textures)
        k = len(mesh.target_names)
        index = builder.add(
            "meshes",
            name=mesh.name,
            primitives=[primitive],
            weights=[0.0] * k if k else None,
            extras={"targetNames": list(mesh.target_names)} if k else None,
        )
        pivot = None if mesh.pivot is None else (mesh.pivot * METRES).tolist()
        builder.add("nodes", name=mesh.name, mesh=index, translation=pivot)
    builder.json["scenes"] = [{"nodes": list(range(len(scene.meshes)))}]
    builder.json["scene"] = 0
    if scene.animation is not None:
        _animate(builder, scene.animation, [mesh.name for mesh in scene.meshes])
    return builder.encode()


def _primitive(builder: GlbBuilder, mesh: SceneMesh, normal_deltas: bool, tolerance_mm: float) -> dict[str, Any]:
    uv_faces = mesh.faces if mesh.uv_faces is None else mesh.uv_faces
    vertex, uv, faces = split_seams(mesh.faces, uv_faces)
    local = mesh.vertices if mesh.pivot is None else mesh.vertices - mesh.pivot
    base = _normals(mesh.vertices, mesh.faces)
    normals = base if mesh.normals is None else mesh.normals
    attributes = {
        "POSITION": builder.accessor(_f4(local[vertex] * METRES), VERTICES, bounds=True),
        "NORMAL": builder.accessor(_f4(normals[vertex]), VERTICES),
    }
    if mesh.uv is not None:
        # glTF's uv origin is the upper left corner.
        attributes["TEXCOORD_0"] = builder.accessor(_f4(mesh.uv[uv] * [1, -1] + [0, 1]), VERTICES)
    index_type = "<u2" if len(vertex) <= 65535 else "<u4"  # 65535 itself would restart the primitive
    primitive: dict[str, Any] = {
        "attributes": attributes,
        "indices": builder.accessor(faces.astype(index_type).ravel(), INDICES),
    }
    if mesh.target_names and mesh.targets is not None:
        primitive["targets"] = [{} for _ in mesh.target_names]
        for entry, delta in zip(primitive["targets"], mesh.targets, strict=True):
            moved = _f4(delta[vertex] * METRES)
            entry["POSITION"] = builder.displacement(moved, tolerance_mm * METRES, bounds=True)
            if normal_deltas:
                turned = _f4((_normals(mesh.vertices + delta, mesh.faces) - base)[vertex])
                entry["NORMAL"] = builder.displacement(turned, _NORMAL_TOLERANCE, bounds=False)
    return primitive


def _normals(V: NDArray[np.floating], F: NDArray[np.integer]) -> NDArray[np.float64]:
    """(n, 3), all of unit length as the format demands: +Z where the faces give none."""
    normals = vertex_normals(V, F)
    return np.where(normals.any(axis=1, keepdims=True), normals, [0.0, 0.0, 1.0])


def _material(builder: GlbBuilder, mesh: SceneMesh, textures: dict[bytes, int]) -> int:
    srgb = np.array(mesh.color)
    # Factors are linear light (IEC 61966-2-1), textures are sRGB.
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    look: dict[str, Any] = {
        "baseColorFactor": [*linear.tolist(), 1.0],
        "metallicFactor": 0.0,
        "roughnessFactor": float(mesh.roughness),
    }
    if mesh.texture is not None:
        look["baseColorTexture"] = {"index": _texture(builder, mesh.texture, textures)}
    return builder.add("materials", name=mesh.name, pbrMetallicRoughness=look)


def _texture(builder: GlbBuilder, pixels: NDArray[np.uint8], textures: dict[bytes, int]) -> int:
    key = str(pixels.shape).encode() + pixels.tobytes()
    if key not in textures:
        if not textures:
            builder.add("samplers", **_SAMPLER)
        image = builder.add("images", bufferView=builder.view(encode_image(pixels)), mimeType="image/png")
        textures[key] = builder.add("textures", source=image, sampler=0)
    return textures[key]


def _animate(builder: GlbBuilder, animation: SceneAnimation, names: list[str]) -> None:
    times = builder.accessor(_f4(animation.times), bounds=True)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    outputs = [(name, "weights", _f4(values).ravel()) for name, values in animation.weights.items()]
    outputs += [(name, "rotation", _f4(values)) for name, values in animation.rotations.items()]
    for name, path, values in outputs:
        channels.append({"sampler": len(samplers), "target": {"node": names.index(name), "path": path}})
        samplers.append({"input": times, "output": builder.accessor(values), "interpolation": "LINEAR"})
    if channels:
        builder.add("animations", name=animation.name, samplers=samplers, channels=channels)


def _f4(array: ArrayLike) -> NDArray[np.float32]:
    return np.ascontiguousarray(array, dtype="<f4")
