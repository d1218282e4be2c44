"""USDZ of any scene, as usd-core reads it."""

import zipfile

import numpy as np
import pytest

from toongeo.geometry.operators.vertex_normals import vertex_normals
from toongeo.io import write_usdz

pytest.importorskip("pxr", reason="needs usd-core")


def test_meshes_materials_and_hostile_names(tmp_path, scene):
    from pxr import Usd, UsdGeom, UsdSkel

    write_usdz(tmp_path / "a.usdz", scene)
    stage = Usd.Stage.Open(str(tmp_path / "a.usdz"))
    names = list(UsdSkel.BindingAPI(stage.GetPrimAtPath("/avatar/head")).GetBlendShapesAttr().Get())
    assert names[:2] == ["jawOpen", "nothing"] and "script" in names[2] and "<" not in names[2]
    for mesh in scene.meshes:
        prim = UsdGeom.Mesh(stage.GetPrimAtPath(f"/avatar/{mesh.name}"))
        np.testing.assert_allclose(np.array(prim.GetPointsAttr().Get()), 1e-3 * mesh.vertices, atol=1e-7)
        np.testing.assert_array_equal(np.array(prim.GetFaceVertexIndicesAttr().Get()), mesh.faces.ravel())
        st = UsdGeom.PrimvarsAPI(prim).GetPrimvar("st")
        if mesh.uv is not None:
            np.testing.assert_allclose(
                np.array(st.ComputeFlattened()), mesh.uv[mesh.uv_faces].reshape(-1, 2), atol=1e-7
            )
    everything = stage.GetPrimAtPath("/avatar/head/nothing")  # an empty shape would be dropped with its name
    assert not np.array(UsdSkel.BlendShape(everything).GetOffsetsAttr().Get()).any()


def test_normals_follow_the_shapes(tmp_path, scene):
    """Normals of the file, with its offsets, are those of the moved mesh."""
    from pxr import Usd, UsdGeom, UsdSkel

    write_usdz(tmp_path / "a.usdz", scene)
    stage = Usd.Stage.Open(str(tmp_path / "a.usdz"))
    for mesh in scene.meshes:
        prim = UsdGeom.Mesh(stage.GetPrimAtPath(f"/avatar/{mesh.name}"))
        assert prim.GetNormalsInterpolation() == "vertex"
        rest = np.array(prim.GetNormalsAttr().Get(), float)
        if mesh.normals is None:
            expected = vertex_normals(mesh.vertices, mesh.faces)
            np.testing.assert_allclose(rest, np.where(expected.any(1)[:, None], expected, [0, 0, 1]), atol=1e-6)
        else:
            np.testing.assert_allclose(rest, mesh.normals, atol=1e-6)
    head = next(mesh for mesh in scene.meshes if mesh.name == "head")
    shape = UsdSkel.BlendShape(stage.GetPrimAtPath("/avatar/head/jawOpen"))
    normals = vertex_normals(head.vertices, head.faces)
    normals[np.array(shape.GetPointIndicesAttr().Get())] += np.array(shape.GetNormalOffsetsAttr().Get())
    moved = vertex_normals(head.vertices + head.targets[0], head.faces)
    np.testing.assert_allclose(normals, moved, atol=0.003)
    assert np.abs(moved - vertex_normals(head.vertices, head.faces)).max() > 0.01


def test_the_package_is_aligned_and_always_the_same(tmp_path, scene):
    write_usdz(tmp_path / "a.usdz", scene)
    write_usdz(tmp_path / "b.usdz", scene)
    content = (tmp_path / "a.usdz").read_bytes()
    assert content == (tmp_path / "b.usdz").read_bytes()
    with zipfile.ZipFile(tmp_path / "a.usdz") as package:
        entries = package.infolist()
        assert package.testzip() is None and entries[0].filename == "scene.usdc"
        for entry in entries:
            name, extra = np.frombuffer(content, "<u2", 2, entry.header_offset + 26)
            assert (entry.header_offset + 30 + name + extra) % 64 == 0 and entry.compress_type == zipfile.ZIP_STORED


def test_an_unwritable_path_leaves_nothing(tmp_path, scene):
    with pytest.raises(OSError, match="nowhere"):
        write_usdz(tmp_path / "nowhere" / "a.usdz", scene)
    assert not list(tmp_path.iterdir())
