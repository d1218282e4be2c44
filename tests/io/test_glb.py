"""GLB: what was written is what is read, to the last bit of float32."""

import json
import struct
from dataclasses import replace

import numpy as np
import pytest

from toongeo.geometry import vertex_normals
from toongeo.io import (
    Scene,
    SceneAnimation,
    SceneMesh,
    encode_glb,
    glb_scene,
    read_glb,
    read_image,
    split_seams,
    write_glb,
    write_image,
)


@pytest.fixture
def document(tmp_path, scene):
    write_glb(tmp_path / "a.glb", scene, tolerance_mm=0)
    return read_glb(tmp_path / "a.glb")


def f4_metres(array):
    return (array * 1e-3).astype(np.float32)


def test_arrays(document, scene):
    for index, mesh in enumerate(scene.meshes):
        primitive = document.json["meshes"][index]["primitives"][0]
        vertex, uv, faces = split_seams(mesh.faces, mesh.faces if mesh.uv_faces is None else mesh.uv_faces)
        pivot = 0 if mesh.pivot is None else mesh.pivot
        got = {name: document.accessors[k] for name, k in primitive["attributes"].items()}
        np.testing.assert_array_equal(got["POSITION"], f4_metres(mesh.vertices - pivot)[vertex])
        np.testing.assert_array_equal(document.accessors[primitive["indices"]].reshape(-1, 3), faces)
        np.testing.assert_allclose(np.linalg.norm(got["NORMAL"], axis=1), 1, atol=1e-6)
        if mesh.uv is not None:
            flipped = np.stack([mesh.uv[:, 0], 1 - mesh.uv[:, 1]], axis=1).astype(np.float32)
            np.testing.assert_array_equal(got["TEXCOORD_0"], flipped[uv])
        deltas = () if mesh.targets is None else mesh.targets
        for target, delta in zip(primitive.get("targets", ()), deltas, strict=True):
            np.testing.assert_array_equal(document.accessors[target["POSITION"]], f4_metres(delta)[vertex])


def test_targets_are_named_weighted_bounded_and_sparse(document, scene):
    head = document.json["meshes"][0]
    assert head["extras"]["targetNames"] == list(scene.meshes[0].target_names)
    assert head["weights"] == [0, 0, 0]
    few, none, every = (document.json["accessors"][t["POSITION"]] for t in head["primitives"][0]["targets"])
    assert "bufferView" not in few and few["sparse"]["count"] == 4
    assert "bufferView" not in none and "sparse" not in none and none["min"] == none["max"] == [0, 0, 0]
    assert "bufferView" in every and "sparse" not in every
    for entry in (few, none, every):
        index = document.json["accessors"].index(entry)
        np.testing.assert_array_equal(document.accessors[index].min(axis=0), np.float32(entry["min"]))
        np.testing.assert_array_equal(document.accessors[index].max(axis=0), np.float32(entry["max"]))


def test_one_texture_is_stored_once_and_exact(tmp_path, document, scene):
    assert len(document.images) == len(document.json["textures"]) == 1  # equal pixels in two arrays
    (tmp_path / "t.png").write_bytes(document.images[0])
    np.testing.assert_array_equal(read_image(tmp_path / "t.png"), scene.meshes[0].texture)
    textured = ["baseColorTexture" in m["pbrMetallicRoughness"] for m in document.json["materials"]]
    assert textured == [True, False, False, True]
    assert not any("doubleSided" in m for m in document.json["materials"])


def test_colour_is_linear(document):
    factor = document.json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"]
    np.testing.assert_allclose(factor, [1, 0.2140411, 0, 1], atol=1e-6)


@pytest.mark.parametrize("with_animation", [False, True])
def test_writing_what_was_read_gives_the_same_bytes(tmp_path, scene, with_animation):
    scene = scene if with_animation else replace(scene, animation=None)
    content = encode_glb(scene, tolerance_mm=0)
    assert content == encode_glb(scene, tolerance_mm=0)
    (tmp_path / "a.glb").write_bytes(content)
    again = glb_scene(read_glb(tmp_path / "a.glb"))
    assert encode_glb(again, tolerance_mm=0) == content
    for got, mesh in zip(again.meshes, scene.meshes, strict=True):
        np.testing.assert_allclose(got.color, mesh.color, atol=1e-12)
        assert (got.name, got.target_names, got.roughness) == (mesh.name, mesh.target_names, mesh.roughness)
        np.testing.assert_allclose(got.vertices[got.faces], mesh.vertices[mesh.faces], atol=1e-4)


def test_animation(document, scene):
    animation = document.json["animations"][0]
    tracks = {
        (c["target"]["node"], c["target"]["path"]): animation["samplers"][c["sampler"]] for c in animation["channels"]
    }
    assert list(tracks) == [(0, "weights"), (1, "weights"), (1, "rotation"), (2, "rotation")]
    for (node, path), sampler in tracks.items():
        name = scene.meshes[node].name
        expected = scene.animation.weights[name].ravel() if path == "weights" else scene.animation.rotations[name]
        np.testing.assert_array_equal(document.accessors[sampler["output"]], expected.astype(np.float32))
        np.testing.assert_array_equal(document.accessors[sampler["input"]], scene.animation.times.astype(np.float32))


def test_tolerance_drops_what_is_small_in_every_coordinate(tmp_path):
    targets = np.array([[[9e-4, 9e-4, 9e-4], [2e-3, 1e-9, 0], [0, 0, 0], [0, 0, 0]]])
    mesh = SceneMesh("m", np.eye(4, 3), np.array([[0, 1, 2], [0, 1, 3]]), targets=targets, target_names=("t",))
    write_glb(tmp_path / "a.glb", Scene((mesh,)))
    got = glb_scene(read_glb(tmp_path / "a.glb")).meshes[0].targets
    np.testing.assert_allclose(got[0, :2], [[0, 0, 0], [2e-3, 1e-9, 0]], rtol=1e-6)
    with pytest.raises(ValueError, match="tolerance_mm: expected >= 0, got -1"):
        encode_glb(Scene((mesh,)), tolerance_mm=-1)


def test_normal_deltas_lead_to_the_normals_of_the_moved_mesh(tmp_path, scene):
    write_glb(tmp_path / "a.glb", scene, normal_deltas=True, tolerance_mm=0)
    document = read_glb(tmp_path / "a.glb")
    mesh, primitive = scene.meshes[0], document.json["meshes"][0]["primitives"][0]
    vertex = split_seams(mesh.faces, mesh.uv_faces)[0]
    for target, delta in zip(primitive["targets"], mesh.targets, strict=True):
        normals = document.accessors[primitive["attributes"]["NORMAL"]] + document.accessors[target["NORMAL"]]
        expected = vertex_normals(mesh.vertices + delta, mesh.faces)[vertex]
        np.testing.assert_allclose(normals, expected, atol=1.1e-3)


def test_a_face_without_area_still_has_unit_normals(tmp_path):
    write_glb(tmp_path / "a.glb", Scene((SceneMesh("m", np.zeros((3, 3)), np.array([[0, 1, 2]])),)))
    np.testing.assert_array_equal(read_glb(tmp_path / "a.glb").accessors[1], [[0, 0, 1]] * 3)


def test_split_seams_keeps_every_corner(scene):
    mesh = scene.meshes[0]
    vertex, uv, faces = split_seams(mesh.faces, mesh.uv_faces)
    np.testing.assert_array_equal(vertex[faces], mesh.faces)
    np.testing.assert_array_equal(uv[faces], mesh.uv_faces)
    assert len(np.unique(np.stack([vertex, uv]), axis=1).T) == len(vertex) == len(mesh.vertices) + 9
    np.testing.assert_array_equal(split_seams(mesh.faces, mesh.faces)[2], mesh.faces)
    with pytest.raises(ValueError, match=r"uv_faces: expected the \(m, 3\) of faces \(1, 3\), got \(2, 3\)"):
        split_seams([[0, 1, 2]], [[0, 1, 2], [0, 1, 2]])


def test_names_are_escaped(document, scene):
    text = json.dumps(document.json)
    assert json.loads(text)["meshes"][0]["extras"]["targetNames"][2] == scene.meshes[0].target_names[2]


def test_nothing_remains_where_it_cannot_be_written(tmp_path, scene):
    (tmp_path / "file").write_bytes(b"")
    for place in ("file/a.glb", "none/a.glb"):
        with pytest.raises(OSError, match=f"cannot write .*{place}: "):
            write_glb(tmp_path / place, scene)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_arguments_stay_as_they_are():
    vertices, faces = np.eye(3), np.array([[0, 1, 2]])
    mesh = SceneMesh("m", vertices, faces)
    assert vertices.flags.writeable and not mesh.vertices.flags.writeable
    encode_glb(Scene((mesh,)))
    np.testing.assert_array_equal(vertices, np.eye(3))


TRIANGLE = {"name": "m", "vertices": np.eye(3), "faces": np.array([[0, 1, 2]])}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"name": ""}, "name: expected a name"),
        ({"vertices": np.eye(3)[:, :2]}, r"vertices of mesh 'm': expected shape \(3, 3\), got \(3, 2\)"),
        ({"vertices": np.full((3, 3), np.nan)}, "vertices of mesh 'm': expected finite"),
        ({"faces": np.array([[0, 1, 3]])}, r"faces of mesh 'm': expected indices in 0..2, got 0..3"),
        ({"faces": np.array([[0, 1, -1]])}, "got -1..1"),
        ({"faces": np.array([[0.0, 1, 2]])}, "integers, m >= 1, got float64"),
        ({"faces": np.zeros((0, 3), int)}, r"integers, m >= 1, got int64 \(0, 3\)"),
        ({"uv": np.zeros((2, 2))}, "uv_faces of mesh 'm': expected indices in 0..1, got 0..2"),
        ({"uv": np.zeros((3, 3))}, r"uv of mesh 'm': expected shape \(3, 2\)"),
        ({"uv_faces": np.array([[0, 1, 2]])}, "uv of mesh 'm': .* got None"),
        ({"texture": np.zeros((2, 2, 3), np.uint8)}, "uv of mesh 'm': .* got None"),
        ({"uv": np.zeros((3, 2)), "texture": np.zeros((2, 2, 3))}, r"uint8, got float64 \(2, 2, 3\)"),
        ({"color": (0, 2, 0)}, "color of mesh 'm': expected 0..1"),
        ({"roughness": -1}, "roughness of mesh 'm': expected 0..1"),
        ({"normals": np.eye(3) * 2}, "normals of mesh 'm': expected vectors of unit length"),
        ({"pivot": np.zeros(2)}, r"pivot of mesh 'm': expected shape \(3,\), got \(2,\)"),
        ({"targets": np.zeros((2, 3, 3))}, "target_names of mesh 'm': expected 2 different names, got 0"),
        ({"targets": np.zeros((2, 3, 3)), "target_names": ("a", "a")}, "expected 2 different names"),
        (
            {"targets": np.zeros((1, 4, 3)), "target_names": ("a",)},
            r"expected shape \(1, 3, 3\), got \(1, 4, 3\)",
        ),
    ],
)
def test_wrong_meshes(change, message):
    with pytest.raises(ValueError, match=message):
        SceneMesh(**TRIANGLE | change)


def test_wrong_scenes_and_animations():
    mesh = SceneMesh(**TRIANGLE)
    with pytest.raises(ValueError, match="meshes: expected at least one"):
        Scene(())
    with pytest.raises(ValueError, match="of different names, got .'m'."):
        Scene((mesh, mesh))
    with pytest.raises(ValueError, match="animation: expected names of meshes .'m'., got 'x'"):
        Scene((mesh,), SceneAnimation([0.0], {"x": np.zeros((1, 1))}))
    with pytest.raises(ValueError, match="weights of 'm' have 1 columns for 0 targets"):
        Scene((mesh,), SceneAnimation([0.0], {"m": np.zeros((1, 1))}))
    for times in ([], [-1.0, 0], [0.0, 0]):
        with pytest.raises(ValueError, match="times: expected increasing seconds"):
            SceneAnimation(times)
    with pytest.raises(ValueError, match=r"weights of 'm': expected shape \(2, None\), got \(1, 1\)"):
        SceneAnimation([0.0, 1], {"m": np.zeros((1, 1))})
    with pytest.raises(ValueError, match="rotations of 'm': expected quaternions of unit length"):
        SceneAnimation([0.0], rotations={"m": np.zeros((1, 4))})


def test_damaged_files(tmp_path, scene):
    content = encode_glb(scene)
    path = tmp_path / "a.glb"
    faults = [b"", b"glTF", b"hello world, no mesh", content[:-8], content[:40], b"glTF\x01" + content[5:]]
    edits = [(b'"count"', b'"c0unt"'), (b'"componentType":5126', b'"componentType":9999')]
    edits += [(b'"buffer":0,', b'"buffer":7,'), (b'"byteLength":', b'"byteLength":9')]
    for old, new in edits:
        edited = content.replace(old, new)
        faults.append(edited[:8] + len(edited).to_bytes(4, "little") + edited[12:])
    for fault in faults:
        path.write_bytes(fault)
        with pytest.raises(ValueError, match=r"expected a GLB .*a\.glb is damaged or none"):
            read_glb(path)
    with pytest.raises(FileNotFoundError):
        read_glb(tmp_path / "none.glb")


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (lambda j: j["nodes"][0].update(scale=[1, 2, 1]), "expected nodes of a mesh, a translation and one scale"),
        (lambda j: j["nodes"][0].pop("mesh"), "expected nodes of a mesh, a translation and one scale"),
        (lambda j: j["meshes"][0]["primitives"].append({}), "expected one primitive a mesh, got 2"),
    ],
)
def test_scenes_of_others_are_refused(document, edit, message):
    edit(document.json)
    with pytest.raises(ValueError, match=message):
        glb_scene(document)


def test_texture_file_and_embedded_texture_agree(tmp_path, scene, document):
    write_image(tmp_path / "t.png", scene.meshes[0].texture)
    assert (tmp_path / "t.png").read_bytes() == document.images[0]


@pytest.mark.parametrize("extension", ["EXT_meshopt_compression", "KHR_draco_mesh_compression"])
def test_packed_arrays_are_called_what_they_are(tmp_path, extension):
    text = json.dumps({"asset": {"version": "2.0"}, "extensionsRequired": [extension]}).encode()
    text += b" " * (-len(text) % 4)
    chunk = struct.pack("<I4s", len(text), b"JSON") + text
    (tmp_path / "a.glb").write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunk)) + chunk)
    with pytest.raises(ValueError, match=rf"path: expected a GLB whose arrays are plain, but .*\({extension}\)"):
        read_glb(tmp_path / "a.glb")


@pytest.mark.parametrize(
    "document", ["[]", "5", '{"bufferViews": 5}', '{"extensionsRequired": 5}', '{"accessors": {}}']
)
def test_json_of_other_types_is_damaged(tmp_path, document):
    text = document.encode() + b" " * (-len(document) % 4)
    chunk = struct.pack("<I4s", len(text), b"JSON") + text
    (tmp_path / "a.glb").write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunk)) + chunk)
    if document == '{"accessors": {}}':
        assert read_glb(tmp_path / "a.glb").accessors == ()
        return
    with pytest.raises(ValueError, match=r"path: expected a GLB \(glTF 2.0\), but .*a\.glb is damaged or none"):
        read_glb(tmp_path / "a.glb")
