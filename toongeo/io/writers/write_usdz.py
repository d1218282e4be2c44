"""A scene as USDZ; the only place that uses usd-core."""

import io
import os
import struct
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from toongeo._extras import missing_extra
from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.io.atomic_write import atomic_write
from toongeo.io.encode_image import encode_image
from toongeo.io.scene import METRES, Scene, SceneMesh

__all__ = ["write_usdz"]

_HEADER = 30  # bytes of a zip entry before its name
_LEAST_TURN = 0.002  # of a normal's coordinate: half a level of a picture
_PADDING = 0x1986  # kind of extra field that USD itself pads with


def write_usdz(path: str | os.PathLike[str], scene: Scene, *, tolerance_mm: float = 1e-3) -> None:
    """Write a ``.usdz``: meshes with UsdSkel blend shapes, a UsdPreviewSurface each, and their textures; atomically.

    In metres, +Y up, the face along +Z. Vertices keep their numbers, uv are a corner's. The skeleton has one joint,
    which does not move; its animation holds the weights, all 0. The scene's own animation is left out. Names become
    valid identifiers: other characters turn into ``_``, and a number tells equal ones apart.

    Parameters
    ----------
    path
        File to write.
    scene
        Model frame, mm.
    tolerance_mm
        Displacements with no coordinate above this are not stored.

    Raises
    ------
    ImportError
        If usd-core is not installed.
    OSError
        If the path cannot be written; nothing half-written remains.
    """
    usd = usd_modules()
    with tempfile.TemporaryDirectory() as folder:
        stage = usd.Usd.Stage.CreateNew(os.path.join(folder, "scene.usdc"))
        usd.UsdGeom.SetStageUpAxis(stage, usd.UsdGeom.Tokens.y)
        usd.UsdGeom.SetStageMetersPerUnit(stage, 1.0)
        root = usd.UsdSkel.Root.Define(stage, "/avatar")
        stage.SetDefaultPrim(root.GetPrim())
        skeleton = _skeleton(usd, stage, scene)
        usd.UsdGeom.Scope.Define(stage, "/avatar/materials")
        pictures: dict[bytes, str] = {}
        taken: set[str] = {"skeleton", "materials"}
        for mesh in scene.meshes:
            name = _identifier(usd, mesh.name, taken)
            material = _material(usd, stage, name, mesh, pictures, folder)
            prim = _mesh(usd, stage, f"/avatar/{name}", mesh, tolerance_mm)
            usd.UsdShade.MaterialBindingAPI.Apply(prim.GetPrim()).Bind(material)
            binding = usd.UsdSkel.BindingAPI.Apply(prim.GetPrim())
            binding.CreateSkeletonRel().SetTargets([skeleton.GetPath()])
            binding.CreateJointIndicesPrimvar(True).Set([0])
            binding.CreateJointWeightsPrimvar(True).Set([1.0])
        stage.GetRootLayer().Save()
        contents = {name: (Path(folder) / name).read_bytes() for name in ("scene.usdc", *pictures.values())}
    atomic_write({path: _package(contents)})


def _package(contents: dict[str, bytes]) -> bytes:
    """A zip file as USDZ wants it: nothing compressed, and every content at a multiple of 64 bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as package:
        for name, content in contents.items():
            entry = zipfile.ZipInfo(name)  # of 1980: no date makes another file of the same scene
            padding = -(stream.tell() + _HEADER + len(name) + 4) % 64
            entry.extra = struct.pack("<HH", _PADDING, padding) + bytes(padding)
            package.writestr(entry, content)
    return stream.getvalue()


class _Modules:
    """The parts of usd-core."""

    def __init__(self) -> None:
        from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdShade, UsdSkel, Vt

        self.Gf, self.Sdf, self.Tf, self.Usd, self.UsdGeom = Gf, Sdf, Tf, Usd, UsdGeom
        self.UsdShade, self.UsdSkel, self.Vt = UsdShade, UsdSkel, Vt


def usd_modules() -> Any:
    """usd-core; ImportError that names the extra to install if it is missing."""
    try:
        return _Modules()
    except ImportError as error:
        raise ImportError(missing_extra("USDZ", "usd")) from error


def _identifier(usd: Any, name: str, taken: set[str]) -> str:
    """A valid name that is not taken yet; it is then."""
    base = usd.Tf.MakeValidIdentifier(name)
    number, valid = 1, base
    while valid in taken:
        number, valid = number + 1, f"{base}_{number + 1}"
    taken.add(valid)
    return valid


def _identifiers(usd: Any, names: tuple[str, ...]) -> list[str]:
    taken: set[str] = set()
    return [_identifier(usd, name, taken) for name in names]


def _skeleton(usd: Any, stage: Any, scene: Scene) -> Any:
    """One joint, and an animation of the weights of all targets."""
    skeleton = usd.UsdSkel.Skeleton.Define(stage, "/avatar/skeleton")
    still = usd.Vt.Matrix4dArray([usd.Gf.Matrix4d(1.0)])
    skeleton.CreateJointsAttr(["head"])
    skeleton.CreateBindTransformsAttr(still)
    skeleton.CreateRestTransformsAttr(still)
    animation = usd.UsdSkel.Animation.Define(stage, "/avatar/skeleton/animation")
    names = list(dict.fromkeys(name for mesh in scene.meshes for name in _identifiers(usd, mesh.target_names)))
    animation.CreateBlendShapesAttr(names)
    animation.CreateBlendShapeWeightsAttr(usd.Vt.FloatArray(len(names), 0.0))
    binding = usd.UsdSkel.BindingAPI.Apply(skeleton.GetPrim())
    binding.CreateAnimationSourceRel().SetTargets([animation.GetPath()])
    return skeleton


def _mesh(usd: Any, stage: Any, path: str, mesh: SceneMesh, tolerance_mm: float) -> Any:
    prim = usd.UsdGeom.Mesh.Define(stage, path)
    points = _points(usd, mesh.vertices * METRES)
    prim.CreatePointsAttr(points)
    prim.CreateFaceVertexCountsAttr(usd.Vt.IntArray(len(mesh.faces), 3))
    prim.CreateFaceVertexIndicesAttr(usd.Vt.IntArray.FromNumpy(mesh.faces.ravel().astype(np.int32)))
    if mesh.double_sided:
        prim.CreateDoubleSidedAttr(True)
    prim.CreateSubdivisionSchemeAttr(usd.UsdGeom.Tokens.none)
    prim.CreateExtentAttr(usd.UsdGeom.PointBased.ComputeExtent(points))
    normals = _normals(mesh.vertices, mesh.faces)
    prim.CreateNormalsAttr(_points(usd, normals if mesh.normals is None else mesh.normals))
    prim.SetNormalsInterpolation(usd.UsdGeom.Tokens.vertex)  # without them programs show every triangle
    if mesh.uv is not None and mesh.uv_faces is not None:
        kinds = usd.Sdf.ValueTypeNames.TexCoord2fArray
        uv = usd.UsdGeom.PrimvarsAPI(prim).CreatePrimvar("st", kinds, usd.UsdGeom.Tokens.faceVarying)
        uv.Set(usd.Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(mesh.uv, np.float32)))
        uv.SetIndices(usd.Vt.IntArray.FromNumpy(mesh.uv_faces.ravel().astype(np.int32)))
    if mesh.targets is not None:
        _blend_shapes(usd, stage, path, prim, mesh, normals, tolerance_mm)
    return prim


def _normals(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """(n, 3) of unit length; forwards where a vertex has none."""
    normals = vertex_normals(V, F)
    return np.where(normals.any(axis=1, keepdims=True), normals, [0.0, 0.0, 1.0])


def _blend_shapes(
    usd: Any, stage: Any, path: str, prim: Any, mesh: SceneMesh, normals: np.ndarray, tolerance_mm: float
) -> None:
    assert mesh.targets is not None
    names, paths = _identifiers(usd, mesh.target_names), []
    for name, delta in zip(names, mesh.targets, strict=True):
        turned = _normals(mesh.vertices + delta, mesh.faces) - normals
        moved = np.flatnonzero(((np.abs(delta) > tolerance_mm) | (np.abs(turned) > _LEAST_TURN)).any(axis=1))
        moved = moved if len(moved) else np.zeros(1, int)  # programs drop a shape without points, and so its name
        shape = usd.UsdSkel.BlendShape.Define(stage, f"{path}/{name}")
        shape.CreateOffsetsAttr(_points(usd, delta[moved] * METRES))
        shape.CreateNormalOffsetsAttr(_points(usd, turned[moved]))
        shape.CreatePointIndicesAttr(usd.Vt.IntArray.FromNumpy(moved.astype(np.int32)))
        paths.append(shape.GetPath())
    binding = usd.UsdSkel.BindingAPI.Apply(prim.GetPrim())
    binding.CreateBlendShapesAttr(names)
    binding.CreateBlendShapeTargetsRel().SetTargets(paths)


def _points(usd: Any, array: np.ndarray) -> Any:
    return usd.Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(array, np.float32))


def _material(usd: Any, stage: Any, name: str, mesh: SceneMesh, pictures: dict[bytes, str], folder: str) -> Any:
    kinds, path = usd.Sdf.ValueTypeNames, f"/avatar/materials/{name}"
    material = usd.UsdShade.Material.Define(stage, path)
    surface = usd.UsdShade.Shader.Define(stage, f"{path}/surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    surface.CreateInput("roughness", kinds.Float).Set(float(mesh.roughness))
    colour = surface.CreateInput("diffuseColor", kinds.Color3f)
    colour.Set(usd.Gf.Vec3f(*mesh.color))
    if mesh.texture is not None:
        key = str(mesh.texture.shape).encode() + mesh.texture.tobytes()
        if key not in pictures:
            pictures[key] = f"texture_{len(pictures)}.png"
            (Path(folder) / pictures[key]).write_bytes(encode_image(mesh.texture))
        reader = usd.UsdShade.Shader.Define(stage, f"{path}/uv")
        reader.CreateIdAttr("UsdPrimvarReader_float2")
        reader.CreateInput("varname", kinds.String).Set("st")
        texture = usd.UsdShade.Shader.Define(stage, f"{path}/texture")
        texture.CreateIdAttr("UsdUVTexture")
        texture.CreateInput("file", kinds.Asset).Set(pictures[key])
        texture.CreateInput("sourceColorSpace", kinds.Token).Set("sRGB")
        texture.CreateInput("st", kinds.Float2).ConnectToSource(reader.CreateOutput("result", kinds.Float2))
        colour.ConnectToSource(texture.CreateOutput("rgb", kinds.Float3))
    material.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
    return material
