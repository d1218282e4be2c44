"""Meshes of other programs: every vertex in its place, and what a file has of uv, texture, normals and nodes."""

import numpy as np
import pytest
import trimesh

from toongeo.io import Scene, read_mesh, write_glb, write_obj, write_ply
from toongeo.io.scene import METRES

KINDS = ("ply", "stl", "off", "glb")


@pytest.fixture
def mesh(scene):
    head = scene.meshes[0]
    return trimesh.Trimesh(head.vertices, head.faces, process=False)


@pytest.mark.parametrize("kind", KINDS)
def test_vertices_and_triangles_are_those_of_the_file(tmp_path, mesh, kind):
    path = tmp_path / f"Kopf ü.{kind.upper()}"
    mesh.export(path, file_type=kind)
    (got,) = read_mesh(path).meshes
    if kind == "stl":  # a format without shared vertices
        np.testing.assert_array_equal(got.faces, np.arange(mesh.faces.size).reshape(-1, 3))
        np.testing.assert_array_equal(got.vertices[got.faces], np.float32(mesh.vertices)[mesh.faces])
    else:
        np.testing.assert_array_equal(got.faces, mesh.faces)
        np.testing.assert_allclose(got.vertices, mesh.vertices, rtol=1e-6)
    assert got.uv is None and got.texture is None


def test_what_the_readers_of_others_would_merge_or_reorder_stays(tmp_path):
    V = np.array([[9.0, 9, 9], [0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])  # one vertex unused
    F = np.array([[4, 5, 6], [1, 2, 3], [1, 1, 2]])
    write_ply(tmp_path / "a.ply", V, F)
    (got,) = read_mesh(tmp_path / "a.ply").meshes
    np.testing.assert_array_equal(got.vertices, V)
    np.testing.assert_array_equal(got.faces, F)


def test_obj_keeps_its_seams(tmp_path, scene):
    head = scene.meshes[0]
    write_obj(tmp_path / "a.obj", Scene((head,)))
    (got,) = read_mesh(tmp_path / "a.obj").meshes
    for name in ("vertices", "faces", "uv", "uv_faces"):
        np.testing.assert_array_equal(getattr(got, name), getattr(head, name))


def test_obj_with_uv_at_some_corners_has_none(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2 3\n")
    assert read_mesh(tmp_path / "a.obj").meshes[0].uv is None


def test_uv_of_a_ply(tmp_path, scene):
    head = scene.meshes[0]
    uv = np.random.default_rng(0).random((len(head.vertices), 2)).astype(np.float32)
    write_ply(tmp_path / "a.ply", head.vertices, head.faces, uv=uv)
    (got,) = read_mesh(tmp_path / "a.ply").meshes
    np.testing.assert_array_equal(got.uv, uv)
    np.testing.assert_array_equal(got.uv_faces, head.faces)


def test_a_glb_of_ours_comes_back(tmp_path, scene):
    """Also its nodes: the eyes are written about their centres."""
    write_glb(tmp_path / "a.glb", scene)
    got = {mesh.name: mesh for mesh in read_mesh(tmp_path / "a.glb").meshes}
    assert list(got) == [mesh.name for mesh in scene.meshes]  # in the file's order
    for mesh in scene.meshes:
        found = got[mesh.name]
        np.testing.assert_allclose(found.vertices[found.faces], METRES * mesh.vertices[mesh.faces], atol=1e-7)
        np.testing.assert_allclose(found.color, mesh.color, atol=0.02)
        if mesh.uv is None:
            assert found.uv is None and found.texture is None
        else:
            np.testing.assert_allclose(found.uv[found.uv_faces], mesh.uv[mesh.uv_faces], atol=1e-6)
            np.testing.assert_array_equal(found.texture, mesh.texture)
    # The normals of the whole surface, not those of its pieces.
    head, whole = got["head"], scene.meshes[0]
    expected = trimesh.Trimesh(whole.vertices, whole.faces, process=False)
    weights = expected.faces_sparse.dot(expected.face_normals * expected.area_faces[:, None])
    weights /= np.linalg.norm(weights, axis=1, keepdims=True)
    np.testing.assert_allclose(head.normals[head.faces], weights[whole.faces], atol=1e-6)


def test_a_mesh_is_shown_as_often_and_where_its_nodes_say(tmp_path, mesh):
    scene = trimesh.Scene()
    mirror = np.diag([-2.0, 2, 2, 1])
    mirror[:3, 3] = [5, 6, 7]
    turn = trimesh.transformations.rotation_matrix(0.7, [1, 2, 3])
    scene.add_geometry(mesh, geom_name="ear", node_name="b", transform=mirror)
    scene.graph.update("a", matrix=turn, geometry="ear")
    scene.export(tmp_path / "a.glb", include_normals=True)
    first, second = read_mesh(tmp_path / "a.glb").meshes
    assert (first.name, second.name) == ("ear.a", "ear.b")
    np.testing.assert_allclose(first.vertices, mesh.vertices @ turn[:3, :3].T, atol=1e-4)
    np.testing.assert_allclose(second.vertices, mesh.vertices * [-2, 2, 2] + [5, 6, 7], atol=1e-4)
    for got in (first, second):  # outside is outside still, by triangles and by normals
        own = trimesh.Trimesh(got.vertices, got.faces, process=False).vertex_normals
        assert (got.normals * own).sum(1).min() > 0.9


def test_files_are_not_opened_for_a_file(tmp_path, scene):
    """A GLB that names a picture beside it is read without."""
    write_glb(tmp_path / "a.glb", scene)
    content = (tmp_path / "a.glb").read_bytes()
    assert content.count(b'"bufferView"') > 1
    secret = tmp_path / "secret.png"
    secret.write_bytes(b"")
    view = content.index(b'"images":[{')
    end = content.index(b"}]", view)
    changed = b'"images":[{"uri":"secret.png"'
    padded = changed + b" " * (end - view - len(changed))
    (tmp_path / "b.glb").write_bytes(content[:view] + padded + content[end:])
    assert read_mesh(tmp_path / "b.glb").meshes[0].texture is None


def test_nothing_is_said_of_a_picture_that_a_file_names(tmp_path, caplog):
    head = "ply\nformat ascii 1.0\ncomment TextureFile skin.png\nelement vertex 3\n"
    rows = (
        "property float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
    )
    (tmp_path / "a.ply").write_text(head + rows + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    assert read_mesh(tmp_path / "a.ply").meshes[0].faces.tolist() == [[0, 1, 2]]
    assert not caplog.records  # trimesh logs a traceback


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("damage", ["cut", "junk", "empty", "text"])
def test_damaged_files_are_named(tmp_path, mesh, kind, damage):
    path = tmp_path / f"a.{kind}"
    mesh.export(path)
    content = path.read_bytes()
    pieces = {"cut": content[: len(content) // 2], "junk": bytes(range(256)) * 9, "empty": b"", "text": b"hello"}
    path.write_bytes(pieces[damage])
    with pytest.raises(ValueError, match=rf"path: expected a (mesh|GLB).*a\.{kind}"):
        read_mesh(path)


def test_meshes_that_no_scene_can_hold_are_refused(tmp_path):
    (tmp_path / "a.off").write_text("OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n")
    with pytest.raises(ValueError, match=r"path: expected a mesh file.*vertices of mesh .*: expected finite numbers"):
        read_mesh(tmp_path / "a.off")
    (tmp_path / "b.off").write_text("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n")
    with pytest.raises(ValueError, match=r"path: expected a mesh.*b\.off"):
        read_mesh(tmp_path / "b.off")


def test_places(tmp_path):
    with pytest.raises(
        ValueError, match=r"path: expected a name that ends in \.obj, \.ply, \.stl, \.off, \.glb, got .*fbx"
    ):
        read_mesh(tmp_path / "a.fbx")
    for suffix in ("obj", "ply", "glb"):
        with pytest.raises(FileNotFoundError):
            read_mesh(tmp_path / f"none.{suffix}")
