"""Avatars with hair: what they keep, what files hold, and what comes back."""

import dataclasses

import numpy as np
import pytest

import toongeo as tg
from tests.pipeline.hair.conftest import helmet
from toongeo.avatar.hair_springs import hair_springs
from toongeo.avatar.making.add_hair import add_hair, under_hair
from toongeo.io import glb_scene, read_glb
from toongeo.protocols import FaceLabel, HairMask


@pytest.fixture(scope="module")
def picture(cartoon):
    return cartoon("moustache_man")


@pytest.fixture(scope="module")
def bald(picture):
    return tg.make_avatar(*picture, hair=False, texture_size=128)


@pytest.fixture(scope="module")
def mask(bald, picture):
    return helmet(bald, picture[0].shape[:2])


@pytest.fixture(scope="module")
def worn(picture, mask):
    stages = []
    avatar = tg.make_avatar(*picture, hair_mask=mask, texture_size=128, progress=stages.append)
    assert "hair" in stages
    return avatar


def same(a, b):
    """Two avatars, but for their reports, bit for bit."""
    for part, names in (("face", ["vertices"]), ("rig", ["neutral", "deltas", "gaze"]), ("parse", ["labels"])):
        for name in names:
            np.testing.assert_array_equal(getattr(getattr(a, part), name), getattr(getattr(b, part), name))
    np.testing.assert_array_equal(a.texture, b.texture)


def test_hair_is_seen_in_pictures(worn, bald):
    crown = worn.render(size=96)[:20]
    assert (np.abs(crown.astype(int) - bald.render(size=96)[:20]).max(2) > 30).sum() > 100
    head, _, _, hair = worn.surfaces()
    assert len(hair.faces) == len(worn.hair.faces)
    assert len(head.faces) == len(worn.faces)


def test_trimesh_gets_the_hair_as_it_is(worn):
    scene = worn.to_trimesh({"jawOpen": 0.6, "eyeLookUpLeft": 1.0}, textured=False)
    assert set(scene.geometry) == {"head", "teeth", "tongue", "eye_left", "eye_right", "hair"}
    np.testing.assert_allclose(scene.geometry["hair"].vertices, worn.hair.vertices, atol=1e-9)
    np.testing.assert_array_equal(scene.geometry["hair"].faces, worn.hair.faces)
    np.testing.assert_allclose(scene.geometry["eye_right"].vertices, worn.eye_vertices(1), atol=1e-9)


@pytest.mark.parametrize("hair", [np.ones((4, 4), bool), "hair.png", None])
def test_what_is_no_modeler_is_refused(picture, hair):
    with pytest.raises(ValueError, match="hair: expected True, False or a HairModeler, got .*hair_mask="):
        tg.make_avatar(*picture, hair=hair)


def test_no_painted_hair_under_hair(worn, bald):
    """The forehead's texels under the shell are as light as the skin, not brown."""
    model = worn.face.model
    forehead = model.region("scalp")[model.faces].all(1)
    from toongeo.render import sample_image, uv_to_px

    uv = model.uv[model.uv_faces[forehead]].mean(1)
    colours = [np.median(sample_image(a.texture, uv_to_px(uv, 128, 128)), axis=0) for a in (worn, bald)]
    assert colours[0][2] > 120 > 80 > colours[1][2]  # blue: skin has some, brown hair none


@pytest.mark.parametrize(
    ("spoil", "reason"),
    [
        (lambda m: m[:-1], "expected the picture's size"),
        (lambda m: m & False, "empty"),
        (lambda m: m | True, "whole picture"),
        (lambda m: np.roll(m, 200, 0) | np.roll(m, 150, 0), "covers the face"),
    ],
)
def test_a_bad_mask_gives_a_reason_and_the_head(picture, mask, bald, spoil, reason):
    avatar = tg.make_avatar(*picture, hair_mask=spoil(mask), texture_size=128)
    assert avatar.hair is None
    assert any(reason in warning for warning in avatar.report.warnings)
    if reason != "covers the face":  # else the parse follows that mask
        same(avatar, bald)


def test_a_modeler_of_ones_own(picture, mask, worn, bald):
    asked = []

    def modeler(img, face, rig, given):
        asked.append((img.shape, given.sum(), len(face.vertices), len(rig.names)))
        return worn.hair

    avatar = tg.make_avatar(*picture, hair=modeler, hair_mask=mask, texture_size=128)
    assert avatar.hair is worn.hair
    assert asked == [(picture[0].shape, mask.sum(), len(bald.face.vertices), 46)]


def test_what_is_refused_is_left_as_it_was(bald, picture, mask):
    unsure = dataclasses.replace(bald.parse, hair=HairMask(mask, False, ("too dark",)))
    head = add_hair(picture[0], bald.face, bald.rig, unsure)
    assert head.face is bald.face
    assert head.rig is bald.rig
    assert (head.hair, head.reasons) == (None, ("too dark",))
    sure = dataclasses.replace(bald.parse, hair=HairMask(mask, True))
    head = add_hair(picture[0], bald.face, bald.rig, sure, lambda *_: None)
    assert head.face is bald.face
    assert head.reasons == ("the modeler built none",)
    assert not (under_hair(sure, bald.face).labels == FaceLabel.HAIR).any()


def test_glb_holds_hair_on_the_head_and_gives_it_back(worn, tmp_path, node):
    for quantize in (False, True):
        path = tmp_path / f"{quantize}.glb"
        worn.save(path, quantize=quantize)
        document = read_glb(path)
        nodes = document.json["nodes"]
        (number,) = (k for k, entry in enumerate(nodes) if entry["name"] == "hair")
        assert nodes[0]["name"] == "head"
        assert nodes[0]["children"] == [number]
        assert number not in document.json["scenes"][0]["nodes"]
        mesh = document.json["meshes"][nodes[number]["mesh"]]
        assert document.json["materials"][mesh["primitives"][0]["material"]]["doubleSided"]
        scene = {m.name: m for m in glb_scene(document).meshes}
        assert scene["hair"].parent == "head"
        assert scene["hair"].double_sided
        again = tg.load_avatar(path)
        np.testing.assert_allclose(again.hair.vertices, worn.hair.vertices, atol=1e-4)
        np.testing.assert_allclose(again.hair.uv, worn.hair.uv, atol=1e-4)
        for name in ("faces", "uv_faces", "texture"):
            np.testing.assert_array_equal(getattr(again.hair, name), getattr(worn.hair, name))
        (verdict,) = node("validate.mjs", path)
        assert (verdict["errors"], verdict["warnings"]) == (0, 0)


def test_all_files_hold_hair(worn, tmp_path, node):
    worn.save(tmp_path / "a.vrm")
    document = read_glb(tmp_path / "a.vrm").json
    (hair,) = (entry for entry in document["nodes"] if entry["name"] == "hair")
    assert "skin" in hair
    (verdict,) = node("validate.mjs", tmp_path / "a.vrm")
    assert (verdict["errors"], verdict["warnings"]) == (0, 0)
    worn.save(tmp_path / "a.obj")
    text = (tmp_path / "a.obj").read_text()
    assert "\no hair\n" in text
    assert (tmp_path / "a_texture_1.png").is_file()
    worn.save(tmp_path / "a.ply")
    eyes, cap = 2 * len(worn.face.model.eyes[0].faces), 84
    header = (tmp_path / "a.ply").read_bytes()[:600].decode("latin1")
    assert f"element face {len(worn.faces) + eyes + len(worn.hair.faces) + cap}\n" in header
    worn.save(tmp_path / "player.glb", names="talkinghead")
    assert "Wolf3D_Hair" in {entry["name"] for entry in read_glb(tmp_path / "player.glb").json["nodes"]}


@pytest.fixture(scope="module")
def long_haired(worn):
    """The lower third of the hair hangs 60 mm below the chin."""
    V = worn.hair.vertices.copy()
    chin = worn.face.vertices[worn.face.landmark_vertices[8], 1]
    line = np.quantile(V[:, 1], 1 / 3)
    low = V[:, 1] < line
    V[low, 1] = line + (V[low, 1] - line) * (line - chin + 60) / (line - V[:, 1].min())
    return dataclasses.replace(worn, hair=dataclasses.replace(worn.hair, vertices=V))


def test_hair_below_the_chin_follows_chains(worn, long_haired):
    assert hair_springs(worn.hair, worn.face) is None
    hair, chin = long_haired.hair, worn.face.vertices[worn.face.landmark_vertices[8], 1]
    springs = hair_springs(hair, long_haired.face)
    follow = springs.weights.sum((1, 2))
    assert not follow[hair.vertices[:, 1] >= chin].any()
    np.testing.assert_allclose(follow[hair.vertices[:, 1] < chin - 20], 1.0, atol=1e-9)
    left, behind, right = springs.joints
    assert left[0, 0] > 0 > right[0, 0] and behind[:, 2].max() < min(left[0, 2], right[0, 2])
    np.testing.assert_allclose(springs.joints[:, 0, 1], chin)
    assert (np.diff(springs.joints[..., 1]) < 0).all()


def test_capsules_fill_neck_and_jaw_and_leave_resting_hair_alone(long_haired):
    """Nothing of the skin is within, so that hair may lie on it, and no end of a bone."""
    face = long_haired.face
    springs = hair_springs(long_haired.hair, face)
    chin = face.vertices[face.landmark_vertices[8], 1]
    assert len(springs.capsules) == 2
    for row, part in zip(springs.capsules, ("neck", "face"), strict=True):
        ends, radius = row[:6].reshape(2, 3), row[6]
        assert 10 < radius < np.ptp(face.vertices[face.region(part), 0]) / 2
        for P in (springs.joints[:, 1:].reshape(-1, 3), face.vertices[face.region("neck")]):
            along = np.clip((P - ends[0]) @ (ends[1] - ends[0]) / max(((ends[1] - ends[0]) ** 2).sum(), 1e-9), 0, 1)
            assert np.linalg.norm(P - ends[0] - along[:, None] * (ends[1] - ends[0]), axis=1).min() > radius - 1e-9
    neck, jaw = springs.capsules
    assert max(neck[1], neck[4]) <= chin <= min(jaw[1], jaw[4]) + 1e-9


def test_hair_sways_in_three_vrm_and_comes_to_rest(long_haired, tmp_path, node):
    long_haired.save(tmp_path / "a.vrm", texture=None)
    (verdict,) = node("validate.mjs", tmp_path / "a.vrm")
    assert (verdict["errors"], verdict["warnings"]) == (0, 0), verdict["messages"]
    (report,) = node("vrm.mjs", tmp_path / "a.vrm")
    sway = report["sway"]
    assert sway["joints"] == 6
    assert 1e-3 < sway["moving"][0] < 0.05
    assert sway["moving"][1] < 1e-9  # the upper half is still
    assert sway["settled"][0] < 1e-4


def test_usdz_holds_hair(worn, tmp_path):
    usd = pytest.importorskip("pxr.Usd")
    worn.save(tmp_path / "a.usdz")
    stage = usd.Stage.Open(str(tmp_path / "a.usdz"))
    prim = stage.GetPrimAtPath("/avatar/hair")
    assert prim.GetAttribute("doubleSided").Get()
    assert len(prim.GetAttribute("points").Get()) == len(worn.hair.vertices)


def test_a_cut_out_face_has_no_hair(worn, tmp_path):
    worn.save(tmp_path / "face.glb", crop="face", loadable=False)
    assert "hair" not in {entry["name"] for entry in read_glb(tmp_path / "face.glb").json["nodes"]}
