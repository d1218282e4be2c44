"""Files of an avatar, as other programs read them."""

import sys
from dataclasses import replace

import numpy as np
import pytest

from toongeo.io import VrmMeta, glb_scene, read_glb, read_obj
from toongeo.model.expression_schemes import SCHEMES

SAVED = {
    "plain": {},
    "dense": {"sparse": False},
    "quantized": {"quantize": True},
    "quantized_dense": {"quantize": True, "sparse": False},
    "normals": {"normals": True},
    "quantized_normals": {"quantize": True, "normals": True},
    "jpeg": {"texture": "jpeg"},
    "untextured": {"texture": None, "animation": None},
    "untextured_quantized": {"texture": None, "animation": None, "quantize": True},
    "face": {"crop": "face", "quantize": True},
    "arkit": {"names": "arkit"},
    "player": {"names": "talkinghead"},
}


@pytest.fixture(scope="module")
def files(avatar, tmp_path_factory):
    folder = tmp_path_factory.mktemp("files")
    for name, options in SAVED.items():
        avatar.save(folder / f"{name}.glb", **options)
    avatar.save(folder / "avatar.vrm")
    return folder


def names_by_mesh(path):
    return {mesh["name"]: mesh.get("extras", {}).get("targetNames", []) for mesh in read_glb(path).json["meshes"]}


def test_the_validator_finds_nothing(files, node):
    verdicts = node("validate.mjs", *(files / f"{name}.glb" for name in SAVED), files / "avatar.vrm")
    for verdict in verdicts:
        assert (verdict["errors"], verdict["warnings"], verdict["hints"]) == (0, 0, 0), verdict["messages"]
        expected = {"UNUSED_OBJECT", "UNSUPPORTED_EXTENSION", "NODE_EMPTY"}
        assert {message["code"] for message in verdict["messages"]} <= expected


def test_files_are_small(files):
    size = {path.stem: path.stat().st_size for path in files.iterdir()}
    assert size["untextured"] <= 8e6 and size["untextured_quantized"] <= 3.2e6
    assert size["plain"] < 0.7 * size["dense"] and size["jpeg"] < size["plain"]


@pytest.mark.parametrize(("name", "off"), [("quantized", 1e-4), ("quantized_dense", 1e-4), ("dense", 1e-6)])
def test_three_js_moves_every_kind_alike(files, node, name, off):
    plain, other = node("load.mjs", files / "plain.glb", files / f"{name}.glb")
    for a, b in zip(plain["meshes"], other["meshes"], strict=True):
        assert (a["name"], a["targets"], a["vertices"]) == (b["name"], b["targets"], b["vertices"])
        # What three.js gives of a scaled node is in its own units.
        scale = b["scale"][0]
        reach = [[mesh["reach"][target] * mesh["scale"][0] for target in a["targets"]] for mesh in (a, b)]
        np.testing.assert_allclose(reach[1], reach[0], atol=off)
        np.testing.assert_allclose(np.array(b["bounds"]) * scale, a["bounds"], atol=1e-6)
    np.testing.assert_allclose(other["animations"][0]["halfway"][0], plain["animations"][0]["halfway"][0])


def test_parts_have_the_targets_that_move_them(avatar, files):
    names = names_by_mesh(files / "plain.glb")
    assert list(names) == ["head", "teeth", "tongue", "eye_left", "eye_right", "neck_cap"]
    assert names["head"] == [*avatar.names, *SCHEMES_GAZE]
    assert set(names["teeth"]) == {"jawForward", "jawLeft", "jawOpen", "jawRight"}
    assert set(names["tongue"]) == {*names["teeth"], "tongueOut"}
    assert all(name.startswith("eyeLook") and name.endswith("Left") for name in names["eye_left"])
    parts = glb_scene(read_glb(files / "plain.glb")).meshes[:3]
    assert sum(len(part.faces) for part in parts) == len(avatar.faces)


SCHEMES_GAZE = [f"eyeLook{way}{side}" for side in ("Left", "Right") for way in ("In", "Out", "Up", "Down")]


def test_arkit_names_are_apples_52(avatar, files):
    scene = glb_scene(read_glb(files / "arkit.glb"))
    head = scene.meshes[0]
    assert head.target_names == tuple(SCHEMES["arkit"]) and len(set(head.target_names)) == 52
    both = avatar.vertices({"browInnerUpLeft": 1.0, "browInnerUpRight": 1.0}) - avatar.vertices()
    got = head.targets[head.target_names.index("browInnerUp")]
    np.testing.assert_allclose(np.abs(got).max(0), np.abs(both).max(0), atol=1e-3)
    # The clip raises both inner brows at 2.6 s.
    weights = scene.animation.weights["head"][:, head.target_names.index("browInnerUp")]
    assert scene.animation.times[weights.argmax()] == pytest.approx(2.6) and weights.max() == pytest.approx(0.8)


def test_players_find_their_names(avatar, files, node):
    document = read_glb(files / "player.glb").json
    (root,) = (document["nodes"][number] for number in document["scenes"][0]["nodes"])
    (bone,) = (node for node in document["nodes"] if node["name"] == "Head")
    names = names_by_mesh(files / "player.glb")
    meshes = ["Wolf3D_Head", "Wolf3D_Teeth", "Wolf3D_Tongue", "EyeLeft", "EyeRight", "Wolf3D_Neck"]
    assert root["name"] == "Armature" and list(names) == [*meshes, "Ground"]
    assert {document["nodes"][child]["name"] for child in bone["children"]} >= set(meshes)
    visemes = {
        f"viseme_{name}"
        for name in ["sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U"]
    }
    extras = {"mouthOpen", "mouthSmile", "eyesClosed", "eyesLookUp", "eyesLookDown"}
    assert set(names["Wolf3D_Head"]) == {*SCHEMES["arkit"], *visemes, *extras}
    (report,) = node("load.mjs", files / "player.glb")
    head, left = report["meshes"][0], report["meshes"][3]
    assert head["reach"]["viseme_aa"] > 0.01 and head["reach"]["viseme_sil"] == 0
    assert left["reach"]["eyesLookUp"] == pytest.approx(left["reach"]["eyeLookUpLeft"])


@pytest.mark.parametrize("columns", [46, 54])
def test_weights_over_time_become_the_animation(avatar, tmp_path, columns):
    rng = np.random.default_rng(0)
    times, weights = np.linspace(0, 1, 7), rng.uniform(0, 1, (7, columns))
    avatar.save(tmp_path / "a.glb", animation=(times, weights))
    scene = glb_scene(read_glb(tmp_path / "a.glb"))
    np.testing.assert_allclose(scene.animation.times, times, atol=1e-6)
    np.testing.assert_allclose(scene.animation.weights["head"][:, :columns], weights, atol=1e-6)
    assert not scene.animation.weights["head"][:, columns:].any()
    tongue = scene.meshes[2].target_names.index("tongueOut")
    np.testing.assert_allclose(
        scene.animation.weights["tongue"][:, tongue], weights[:, avatar.names.index("tongueOut")], atol=1e-6
    )
    avatar.save(tmp_path / "still.glb", animation=None)
    assert "animations" not in read_glb(tmp_path / "still.glb").json


@pytest.mark.parametrize(
    ("path", "options", "message"),
    [
        ("a.glb", {"quantise": True}, r"quantise: no option of \.glb, which has crop, quantize, normals"),
        ("a.obj", {"quantize": True}, r"quantize: no option of \.obj, which has crop"),
        ("a", {"format": "fbx"}, r"format: expected one of \.glb, .*obj-sequence, got 'fbx'"),
        ("a.glb", {"texture": "gif"}, "texture: expected 'png', 'jpeg' or None, got 'gif'"),
        ("a.vrm", {"texture": "gif"}, "texture: expected 'png', 'jpeg' or None, got 'gif'"),
        ("a.glb", {"names": "facs"}, "names: expected one of toongeo, arkit, talkinghead, got 'facs'"),
        ("a.glb", {"animation": "dance"}, "animation: expected 'demo', None, or times, weights and turns"),
        ("a.glb", {"animation": ([0.0], np.zeros((1, 52)))}, r"animation: expected weights \(f, 46\) or \(f, 54\)"),
        ("a.glb", {"animation": ([0.0, 0.0], np.zeros((2, 46)))}, "times: expected increasing seconds"),
        ("a.glb", {"animation": ([0.0], np.full((1, 46), np.nan))}, "expected finite weights up to"),
    ],
)
def test_bad_options_are_refused_and_nothing_is_written(avatar, tmp_path, path, options, message):
    with pytest.raises(ValueError, match=message):
        avatar.save(tmp_path / path, **options)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("path", ["a.glb", "a.vrm", "a.obj", "a.ply", "obj-sequence"])
def test_an_unwritable_path_is_told_and_leaves_nothing(avatar, tmp_path, path):
    target = tmp_path / "nowhere" / path
    with pytest.raises(OSError, match="nowhere"):
        avatar.save(target, format="obj-sequence" if path == "obj-sequence" else None)
    assert not list(tmp_path.iterdir())


def test_three_vrm_loads_expressions_bones_and_gaze(avatar, files, node):
    (report,) = node("vrm.mjs", files / "avatar.vrm")
    assert set(report["presets"]) == set(SCHEMES["vrm"]) and set(report["custom"]) == set(SCHEMES["arkit"])
    assert report["meta"]["avatarPermission"] == "onlyAuthor" and report["meta"]["allowRedistribution"] is False
    for name in SCHEMES["arkit"]:
        if not name.startswith("eyeLook"):
            expected = np.linalg.norm(avatar.vertices(SCHEMES["arkit"][name]) - avatar.vertices(), axis=1).max()
            assert max(report["moves"][name].values()) == pytest.approx(1e-3 * expected, abs=2e-6), name
    assert report["moves"]["happy"]["head"] > 5e-3 and report["moves"]["neutral"]["head"] == 0
    # Full gaze turns the eyes as far as the rig's own names do; +X is the subject's left.
    for side in (0, 1):
        np.testing.assert_allclose(report["gaze"]["left"][side], [0.5, 0, np.sqrt(0.75)], atol=1e-6)
        down = np.radians(avatar.eyes.turn[:, 1].min())
        np.testing.assert_allclose(report["gaze"]["down"][side], [0, -np.sin(down), np.cos(down)], atol=1e-6)


def test_the_body_of_bones_is_where_a_body_is(avatar, files, node):
    (report,) = node("vrm.mjs", files / "avatar.vrm")
    bones = {name: np.array(place) for name, place in report["bones"].items()}
    required = ["hips", "spine", "head"]
    required += [f"{side}{part}" for side in ("left", "right") for part in ("UpperArm", "LowerArm", "Hand")]
    required += [f"{side}{part}" for side in ("left", "right") for part in ("UpperLeg", "LowerLeg", "Foot")]
    assert set(bones) == {*required, "neck", "leftEye", "rightEye"}
    assert 0 < bones["leftFoot"][1] < bones["leftLowerLeg"][1] < bones["hips"][1] < bones["spine"][1]
    assert bones["spine"][1] < bones["neck"][1] < bones["head"][1] < bones["leftEye"][1] < 1.7
    assert bones["leftHand"][0] > bones["leftLowerArm"][0] > bones["leftUpperArm"][0] > 0 > bones["rightHand"][0]
    np.testing.assert_allclose(
        bones["leftEye"] - bones["rightEye"], 1e-3 * (avatar.eyes.centres[0] - avatar.eyes.centres[1]), atol=1e-9
    )
    low, high = report["heights"]["head"]
    assert low < bones["head"][1] < bones["leftEye"][1] < high


def test_the_licence_of_a_vrm_is_the_users(avatar, tmp_path):
    meta = VrmMeta(
        name='"><script>', authors=("Ada", "../Bob"), allow_redistribution=True, commercial_usage="corporation"
    )
    avatar.save(tmp_path / "a.vrm", meta=meta, texture=None)
    entry = read_glb(tmp_path / "a.vrm").json["extensions"]["VRMC_vrm"]["meta"]
    assert (entry["name"], entry["authors"]) == ('"><script>', ["Ada", "../Bob"])
    assert entry["allowRedistribution"] is True and entry["commercialUsage"] == "corporation"
    assert "copyrightInformation" not in entry and "images" not in read_glb(tmp_path / "a.vrm").json


def test_a_sequence_of_obj_is_every_expression(avatar, tmp_path):
    avatar.save(tmp_path / "faces", format="obj-sequence")
    files = sorted(path.name for path in (tmp_path / "faces").iterdir())
    assert files[0] == "000_neutral.obj" and files[-2:] == ["face.mtl", "face_texture.png"] and len(files) == 55 + 2
    neutral = read_obj(tmp_path / "faces" / "000_neutral.obj")
    for name in ("jawOpen", "eyeLookUpLeft"):
        (found,) = (tmp_path / "faces").glob(f"*_{name}.obj")
        data = read_obj(found)
        n, k = len(avatar.vertices()), len(avatar.eye_vertices(0))
        np.testing.assert_array_equal(data.faces, neutral.faces)
        np.testing.assert_allclose(data.vertices[:n], avatar.vertices({name: 1.0}), atol=2e-5)
        np.testing.assert_allclose(data.vertices[n : n + k], avatar.eye_vertices(0, {name: 1.0}), atol=2e-5)
        assert b"mtllib face.mtl" in found.read_bytes()


def test_hostile_names_of_expressions_reach_no_path(avatar, tmp_path):
    names = ("../../evil", '"><script>', *avatar.names[2:])
    rig = replace(avatar.rig, names=names)
    replace(avatar, rig=rig).save(tmp_path / "faces", format="obj-sequence")
    assert {path.name for path in tmp_path.iterdir()} == {"faces"}
    assert {"001_______evil.obj", "002____script_.obj"} < {path.name for path in (tmp_path / "faces").iterdir()}


def test_without_usd_the_extra_is_named(avatar, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(ImportError, match='pip install "usd-core>='):
        avatar.save(tmp_path / "a.usdz")
    assert not list(tmp_path.iterdir())


def test_usdz_opens_with_every_target(avatar, tmp_path):
    pxr = pytest.importorskip("pxr", reason="needs usd-core")
    from pxr import Usd, UsdGeom, UsdShade, UsdSkel

    assert pxr
    avatar.save(tmp_path / "a.usdz")
    stage = Usd.Stage.Open(str(tmp_path / "a.usdz"))
    assert UsdGeom.GetStageUpAxis(stage) == "Y" and UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    head = stage.GetPrimAtPath("/avatar/head")
    binding = UsdSkel.BindingAPI(head)
    assert list(binding.GetBlendShapesAttr().Get()) == [*avatar.names, *SCHEMES_GAZE]
    points = np.array(UsdGeom.Mesh(head).GetPointsAttr().Get())
    jaw = UsdSkel.BlendShape(stage.GetPrimAtPath("/avatar/head/jawOpen"))
    moved = np.zeros_like(points)
    moved[np.array(jaw.GetPointIndicesAttr().Get())] = np.array(jaw.GetOffsetsAttr().Get())
    skin = np.unique(avatar.faces[~np.any([avatar.face.region(r) for r in TEETH], axis=0)[avatar.faces].any(1)])
    np.testing.assert_allclose(points, 1e-3 * avatar.vertices()[skin], atol=1e-7)
    np.testing.assert_allclose(points + moved, 1e-3 * avatar.vertices({"jawOpen": 1.0})[skin], atol=2e-7)
    material = UsdShade.MaterialBindingAPI(head).ComputeBoundMaterial()[0]
    texture = UsdShade.Shader(stage.GetPrimAtPath(material.GetPath().AppendChild("texture")))
    assert texture.GetInput("file").Get().resolvedPath.endswith("a.usdz[texture_0.png]")
    animation = UsdSkel.Animation(stage.GetPrimAtPath("/avatar/skeleton/animation"))
    assert set(animation.GetBlendShapesAttr().Get()) == {*avatar.names, *SCHEMES_GAZE}


TEETH = ("teeth_upper", "teeth_lower", "tongue")
