"""How a GLB stores what it stores: integers, shared numbers, attachments."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.io import Scene, SceneMesh, encode_glb, glb_scene, read_glb, split_seams, write_glb


def read(tmp_path, scene, **options):
    write_glb(tmp_path / "a.glb", scene, **options)
    return read_glb(tmp_path / "a.glb")


@pytest.mark.parametrize("sparse", [False, True])
@pytest.mark.parametrize("normal_deltas", [False, True])
def test_quantized_displacements_are_off_by_half_a_unit(tmp_path, scene, sparse, normal_deltas):
    document = read(tmp_path, scene, quantize=True, sparse=sparse, normal_deltas=normal_deltas, tolerance_mm=0)
    assert document.json["extensionsRequired"] == ["KHR_mesh_quantization"]
    first = document.json["meshes"][0]["primitives"][0]["attributes"]
    kinds = {name: document.accessors[number].dtype for name, number in first.items()}
    assert kinds == {"POSITION": np.float32, "NORMAL": np.int8, "TEXCOORD_0": np.uint16}
    for mesh, got in zip(scene.meshes, glb_scene(document).meshes, strict=True):
        vertex, uv, faces = split_seams(mesh.faces, mesh.faces if mesh.uv_faces is None else mesh.uv_faces)
        local = mesh.vertices - (0 if mesh.pivot is None else mesh.pivot)
        unit = np.abs(local).max() / 2048
        np.testing.assert_array_equal(got.faces, faces)
        np.testing.assert_allclose(got.vertices, mesh.vertices[vertex], rtol=1e-6, atol=1e-5)
        if mesh.targets is not None:
            np.testing.assert_allclose(got.targets, mesh.targets[:, vertex], atol=0.51 * unit)
        if mesh.uv is not None:
            np.testing.assert_allclose(got.uv, mesh.uv[uv], atol=1 / 65535)
        assert got.target_names == mesh.target_names


def test_displacements_of_any_size_fit(tmp_path):
    """Great ones beside a small mesh: the unit grows with them."""
    targets = np.zeros((2, 3, 3))
    targets[0, 0], targets[1, 1] = [5e4, 0, -1e-9], [0, 1e-3, 0]
    mesh = SceneMesh("a", np.eye(3), np.array([[0, 1, 2]]), targets=targets, target_names=("far", "near"))
    (got,) = glb_scene(read(tmp_path, Scene((mesh,)), quantize=True, tolerance_mm=0)).meshes
    np.testing.assert_allclose(got.targets, targets, atol=0.51 * 5e4 / 32767)
    flat = SceneMesh("flat", np.zeros((3, 3)), np.array([[0, 1, 2]]))
    assert not glb_scene(read(tmp_path, Scene((flat,)), quantize=True)).meshes[0].vertices.any()


def sheet(n, targets):
    """n vertices in a strip, with these targets."""
    vertices = np.random.default_rng(0).standard_normal((n, 3))
    faces = np.stack([np.arange(n - 2), np.arange(1, n - 1), np.arange(2, n)], axis=1)
    names = tuple(f"t{number}" for number in range(len(targets)))
    return Scene((SceneMesh("sheet", vertices, faces, targets=targets, target_names=names),))


def positions(document):
    """Accessor of each target of the first mesh."""
    return [target["POSITION"] for target in document.json["meshes"][0]["primitives"][0]["targets"]]


def test_targets_of_one_region_share_their_numbers(tmp_path):
    rng, n = np.random.default_rng(0), 1000
    targets = np.zeros((9, n, 3))
    targets[:5, :600] = rng.uniform(1, 2, (5, 600, 3))
    targets[3, 10:20] = 0  # still cheapest with the others' numbers
    targets[5, 700:710] = 1  # its own
    targets[6, 300:305] = 1  # inside the region, but so few
    targets[7] = rng.uniform(1, 2, (n, 3))  # all rows
    document = read(tmp_path, sheet(n, targets), tolerance_mm=0)
    entries = [
        document.json["accessors"][t["POSITION"]] for t in document.json["meshes"][0]["primitives"][0]["targets"]
    ]
    views = [entry["sparse"]["indices"]["bufferView"] if "sparse" in entry else None for entry in entries]
    assert len(set(views[:5])) == 1 and views[5] not in views[:5] and views[6] not in views[:6]
    assert [entry["sparse"]["count"] for entry in entries[:7]] == [600] * 5 + [10, 5]
    assert "sparse" not in entries[7] and "bufferView" in entries[7]
    assert "sparse" not in entries[8] and "bufferView" not in entries[8]  # moves nothing
    np.testing.assert_allclose(glb_scene(document).meshes[0].targets, targets, rtol=1e-6)


def test_small_displacements_take_a_byte(tmp_path):
    targets = np.zeros((2, 50, 3))
    targets[0, :20], targets[1, :20] = 0.05, 5.0
    scene = sheet(50, targets)
    document = read(tmp_path, scene, quantize=True, tolerance_mm=0)
    assert [document.accessors[number].dtype for number in positions(document)] == [np.int8, np.int16]


def test_dense_files_have_no_sparse_accessor(tmp_path, scene):
    dense, sparse = (read(tmp_path, scene, tolerance_mm=0, sparse=flag) for flag in (False, True))
    assert not any("sparse" in entry for entry in dense.json["accessors"])
    assert any("sparse" in entry for entry in sparse.json["accessors"])
    for a, b in zip(glb_scene(dense).meshes, glb_scene(sparse).meshes, strict=True):
        if a.target_names:
            np.testing.assert_array_equal(a.targets, b.targets)


def test_attachments_come_back_and_tell_of_changes(tmp_path, scene, node):
    document = read(tmp_path, scene, attachment=b"anything \0\xff")
    assert document.attachment == b"anything \0\xff" and document.intact
    (verdict,) = node("validate.mjs", tmp_path / "a.glb")
    assert (verdict["errors"], verdict["warnings"]) == (0, 0)
    content = (tmp_path / "a.glb").read_bytes()
    for other in (
        content.replace(b"jawOpen", b"jawOpem"),
        content.replace(b'"sha256":"', b'"sha256":"\\u0030', 1)[: len(content)],
    ):
        (tmp_path / "b.glb").write_bytes(other)
        if len(other) == len(content) and b"jawOpem" in other:
            assert not read_glb(tmp_path / "b.glb").intact
    plain = read(tmp_path, scene)
    assert plain.attachment is None and not plain.intact


def test_names_cannot_pass_for_the_checksum(tmp_path, scene):
    name = '"sha256":"' + "0" * 64 + '"'
    mesh = replace(scene.meshes[0], name=name)
    document = read(tmp_path, Scene((mesh,)), attachment=b"x")
    assert document.intact and document.json["nodes"][0]["name"] == name


def test_a_checksum_that_is_none_is_not_intact(tmp_path, scene):
    content = encode_glb(scene, attachment=b"x")
    at = content.index(b'"sha256":"') + 10
    (tmp_path / "a.glb").write_bytes(content[:at] + b"Z" * 64 + content[at + 64 :])
    assert not read_glb(tmp_path / "a.glb").intact


def places(nodes, node, above):
    """Where each node below is, m: a slow reference for what a player makes of translations and rotations."""
    entry = nodes[node]
    local = np.eye(4)
    local[:3, :3] = Rotation.from_quat(entry.get("rotation", [0, 0, 0, 1])).as_matrix()
    local[:3, 3] = entry.get("translation", [0, 0, 0])
    world = above @ local
    found = {entry["name"]: world[:3, 3]}
    for child in entry.get("children", ()):
        found |= places(nodes, child, world)
    return found


def test_a_body_stands_on_the_ground_in_t_pose(tmp_path, scene):
    document = read(tmp_path, scene, body="mixamo").json
    (root,) = document["scenes"][0]["nodes"]
    assert document["nodes"][root]["name"] == "Armature"
    found = places(document["nodes"], root, np.eye(4))
    assert len(found) == 67 + len(scene.meshes) + 2 == len(document["nodes"])
    assert abs(found["LeftToe_End"][1]) < 0.1 and 1.5 < found["Head"][1] < 1.6
    for name in ("Hips", "Neck", "Head"):
        assert found[name][0] == 0
    left, right = found["LeftHandMiddle4"], found["RightHandMiddle4"]
    np.testing.assert_allclose(left * [-1, 1, 1], right, atol=1e-9)
    assert left[0] > 0.7 and abs(left[1] - found["LeftArm"][1]) < 1e-9
    assert found["LeftToe_End"][2] > found["LeftFoot"][2] + 0.05


def test_meshes_keep_their_places_on_a_body(tmp_path, scene):
    """All of the scene is moved by the same way, with the bone of the head, and its clip plays on."""
    plain, worn = read(tmp_path, scene).json, read(tmp_path, scene, body="mixamo").json
    free = {}
    for node in plain["scenes"][0]["nodes"]:
        free |= places(plain["nodes"], node, np.eye(4))
    found = places(worn["nodes"], worn["scenes"][0]["nodes"][0], np.eye(4))
    for mesh in scene.meshes:
        np.testing.assert_allclose(found[mesh.name] - free[mesh.name], found["Head"] - [0, -0.085, -0.08], atol=1e-9)
    assert worn["animations"] == plain["animations"]


def test_a_head_turns_about_its_neck(tmp_path, scene, node):
    """Two nodes above the meshes, whose own entries are as before; the file is read back as it was."""
    angle = 0.5 * np.sin(scene.animation.times)
    turns = np.stack([0 * angle, np.sin(angle / 2), 0 * angle, np.cos(angle / 2)], axis=1)
    turning = replace(scene.animation, turns=turns, neck=np.array([0.0, -85, -80]))
    plain, document = read(tmp_path, scene), read(tmp_path, replace(scene, animation=turning))
    count = len(scene.meshes)
    assert document.json["nodes"][:count] == plain.json["nodes"] and len(document.json["nodes"]) == count + 2
    (root,) = document.json["scenes"][0]["nodes"]
    found, free = places(document.json["nodes"], root, np.eye(4)), {}
    for top in plain.json["scenes"][0]["nodes"]:
        free |= places(plain.json["nodes"], top, np.eye(4))
    for mesh in scene.meshes:
        np.testing.assert_allclose(found[mesh.name], free[mesh.name], atol=1e-9)
    again = glb_scene(document)
    np.testing.assert_allclose(again.animation.turns, turns, atol=1e-6)
    np.testing.assert_allclose(again.animation.neck, [0, -85, -80], atol=1e-4)
    assert encode_glb(again, tolerance_mm=0) == encode_glb(
        glb_scene(read(tmp_path, again, tolerance_mm=0)), tolerance_mm=0
    )
    write_glb(tmp_path / "a.glb", replace(scene, animation=turning))
    (verdict,) = node("validate.mjs", tmp_path / "a.glb")
    assert (verdict["errors"], verdict["warnings"]) == (0, 0)
    with pytest.raises(ValueError, match="turns, neck: expected both or neither"):
        replace(scene.animation, turns=turns)
    with pytest.raises(ValueError, match="turns: expected quaternions of unit length"):
        replace(turning, turns=2 * turns)


def test_an_unknown_body_is_refused(scene):
    with pytest.raises(ValueError, match="body: expected 'mixamo' or None, got 'robot'"):
        encode_glb(scene, body="robot")


def test_an_unknown_picture_is_refused(tmp_path, scene):
    with pytest.raises(ValueError, match="picture: expected 'png' or 'jpeg', got 'gif'"):
        write_glb(tmp_path / "a.glb", scene, picture="gif")
    assert not list(tmp_path.iterdir())


def test_jpeg_is_told_by_its_type(tmp_path, scene):
    document = read(tmp_path, scene, picture="jpeg")
    assert {image["mimeType"] for image in document.json["images"]} == {"image/jpeg"}
    assert document.images[0][:3] == b"\xff\xd8\xff"


@pytest.mark.parametrize("field", ["nodes", "meshes", "materials", "animations", "accessors"])
def test_scenes_with_a_part_missing_are_refused(tmp_path, scene, field):
    document = read(tmp_path, scene)
    document.json[field] = [{}]
    with pytest.raises(ValueError, match="document: |meshes: |index"):
        glb_scene(document)


def test_a_picture_that_is_none_is_refused(tmp_path, scene):
    document = read(tmp_path, scene)
    with pytest.raises(ValueError, match="document: "):
        glb_scene(replace(document, images=(b"no picture",) * len(document.images)))
