"""An animation on files of other programs."""

import json
import struct

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from toongeo.io import animate_glb, head_bone, morph_targets, read_glb, write_glb


@pytest.fixture
def foreign(tmp_path, scene):
    """A file with what we never write: a turned parent, a skinned node, a camera and an animation of its own."""
    path = tmp_path / "foreign.glb"
    write_glb(path, scene)
    content = path.read_bytes()
    size = struct.unpack_from("<I", content, 12)[0]
    document, rest = json.loads(content[20 : 20 + size]), content[20 + size :]
    meshes = [k for k, node in enumerate(document["nodes"]) if "mesh" in node]
    document["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}]
    document["nodes"] += [{"name": "Armature", "rotation": [0.5, 0.5, 0.5, 0.5], "children": meshes, "camera": 0}]
    document["scenes"] = [{"nodes": [len(document["nodes"]) - 1]}]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest))
    path.write_bytes(head + struct.pack("<I4s", len(text), b"JSON") + text + rest)
    return path


def test_the_targets_move_and_the_rest_stays(tmp_path, foreign):
    before = read_glb(foreign)
    times, jaw = np.array([0.0, 0.5, 2.0]), np.array([0.0, 1.0, 0.25])
    animate_glb(foreign, tmp_path / "out.glb", times, {"jawOpen": jaw}, name="speech")
    after = read_glb(tmp_path / "out.glb")
    for key in ("nodes", "meshes", "materials", "cameras", "scenes", "images"):
        assert after.json[key] == before.json[key]
    for old, new in zip(before.accessors, after.accessors, strict=False):
        np.testing.assert_array_equal(old, new)
    assert after.images == before.images
    first, *others = after.json["animations"]
    assert first["name"] == "speech" and others == before.json.get("animations", [])
    moved = [k for k, node in enumerate(before.json["nodes"])
             if "jawOpen" in morph_targets(before.json).get(node.get("mesh"), ())]  # fmt: skip
    assert [channel["target"] for channel in first["channels"]] == [{"node": k, "path": "weights"} for k in moved]
    for channel in first["channels"]:
        sampler = first["samplers"][channel["sampler"]]
        names = morph_targets(before.json)[before.json["nodes"][channel["target"]["node"]]["mesh"]]
        values = after.accessors[sampler["output"]].reshape(3, len(names))
        np.testing.assert_array_equal(after.accessors[sampler["input"]], times.astype(np.float32))
        np.testing.assert_array_equal(values[:, names.index("jawOpen")], jaw.astype(np.float32))
        assert np.count_nonzero(values) == 2


def test_the_bone_of_the_head_turns_in_the_world(tmp_path, scene, foreign):
    """Whatever way it and those above it are turned themselves."""
    write_glb(tmp_path / "body.glb", scene, body="mixamo")
    content = (tmp_path / "body.glb").read_bytes()
    size = struct.unpack_from("<I", content, 12)[0]
    document, rest = json.loads(content[20 : 20 + size]), content[20 + size :]
    numbers = {node["name"]: k for k, node in enumerate(document["nodes"])}
    above = {child: k for k, node in enumerate(document["nodes"]) for child in node.get("children", ())}
    for name, turn in (("Spine", [0.5, 0.5, 0.5, 0.5]), ("Head", [0.0, 0.6, 0.0, 0.8])):
        document["nodes"][numbers[name]]["rotation"] = turn
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest))
    (tmp_path / "body.glb").write_bytes(head + struct.pack("<I4s", len(text), b"JSON") + text + rest)
    turns = Rotation.from_euler("YXZ", [[0, 0, 0], [0.5, 0.2, -0.1]])
    times = np.array([0.0, 1.0])
    animate_glb(tmp_path / "body.glb", tmp_path / "out.glb", times, {"jawOpen": times}, turns=turns.as_quat())
    after = read_glb(tmp_path / "out.glb")
    clip = after.json["animations"][0]
    (channel,) = (entry for entry in clip["channels"] if entry["target"]["path"] == "rotation")
    assert channel["target"]["node"] == numbers["Head"] == head_bone(after.json)
    local = after.accessors[clip["samplers"][channel["sampler"]]["output"]]

    def world(turn):
        number, found = numbers["Head"], Rotation.from_quat(turn)
        while number in above:
            number = above[number]
            found = Rotation.from_quat(document["nodes"][number].get("rotation", [0, 0, 0, 1])) * found
        return found

    rest = world([0.0, 0.6, 0.0, 0.8])
    for turn, wanted in zip(local, turns, strict=True):
        np.testing.assert_allclose((world(turn) * rest.inv()).as_matrix(), wanted.as_matrix(), atol=1e-6)
    with pytest.raises(ValueError, match=r"turns: expected \(2, 4\) and a bone named head, got \(2, 4\), node None"):
        animate_glb(foreign, tmp_path / "no.glb", times, {"jawOpen": times}, turns=turns.as_quat())


def test_it_is_valid(tmp_path, foreign, node):
    animate_glb(foreign, tmp_path / "out.glb", np.array([0.0, 1.0]), {"jawOpen": np.array([0.0, 1.0])})
    (verdict,) = node("validate.mjs", tmp_path / "out.glb")
    assert verdict["errors"] == 0


@pytest.mark.parametrize(
    ("times", "weights", "message"),
    [
        ([0.0, 0.0], {"jawOpen": [0, 1]}, "times: expected increasing seconds"),
        ([-1.0, 0.0], {"jawOpen": [0, 1]}, "times: expected increasing seconds"),
        ([], {"jawOpen": []}, "times: expected increasing seconds"),
        ([0.0, 1.0], {"jawOpen": [0, 1, 2]}, r"weights: expected \(2,\) finite numbers for 'jawOpen', got \(3,\)"),
        ([0.0, 1.0], {"jawOpen": [0, np.nan]}, r"weights: expected \(2,\) finite numbers for 'jawOpen'"),
        ([0.0, 1.0], {"smile": [0, 1]}, "weights: expected targets of .*foreign.glb, got smile"),
    ],
)
def test_what_does_not_fit_is_refused(tmp_path, foreign, times, weights, message):
    with pytest.raises(ValueError, match=message):
        animate_glb(foreign, tmp_path / "out.glb", np.array(times), {k: np.array(v) for k, v in weights.items()})
    assert not (tmp_path / "out.glb").exists()


@pytest.mark.parametrize(
    "mesh",
    [
        {},
        {"primitives": [{"targets": [{}]}]},
        {"primitives": [{"targets": [{}]}], "extras": {"targetNames": ["a", "b"]}},
        {"primitives": [{"targets": [{}]}], "extras": {"targetNames": [7]}},
        {"primitives": [{}], "extras": 7},
    ],
)
def test_targets_without_names_are_none(mesh):
    assert morph_targets({"meshes": [mesh]}) == {}
