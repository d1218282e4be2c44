"""Avatars of models that do not have all that the template has."""

from dataclasses import replace

import numpy as np
import pytest

from toongeo.avatar.load_avatar import load_avatar
from toongeo.avatar.make_avatar import make_avatar
from toongeo.avatar.missing_parts import missing_parts
from toongeo.io import read_glb, read_obj
from toongeo.model import MorphableModel, load_eos, load_ict_facekit
from toongeo.model.anatomy.gaze import GAZE_NAMES

PICTURES = ("moustache_man", "bad_guy", "blonde_girl_threequarter")
SIZE = 256  # texels: what is tested does not depend on it


@pytest.fixture(scope="module")
def models(request, model):
    """``models(name)``; those of others skip where they are not at hand."""

    def surrey():
        folder = request.getfixturevalue("shared") / "data" / "models" / "sfm"
        files = ("sfm_shape_3448.bin", "ibug_to_sfm.txt", "expression_blendshapes_3448.bin")
        return load_eos(*(folder / name for name in files))

    def ict():
        folder = request.getfixturevalue("shared") / "data" / "models" / "ict_facekit"
        return load_ict_facekit(folder / "ict_facekit_light.npz")

    def skin():
        return bare_skin(model)

    known, made = {"surrey": surrey, "ict": ict, "skin": skin}, {}

    def get(name):
        if name not in made:
            made[name] = known[name]()
        return made[name]

    return get


def bare_skin(model):
    """The template's skin without anything but its triangles, how people differ, and landmarks."""
    kept = np.flatnonzero(model.region("skin"))
    new = np.full(len(model.mean), -1)
    new[kept] = np.arange(len(kept))
    faces = new[model.faces]
    return MorphableModel(
        mean=model.mean[kept],
        faces=faces[(faces >= 0).all(1)],
        identity=model.identity[:10, kept],
        landmarks=new[model.landmarks],
    )


@pytest.fixture(scope="module")
def avatars(models, cartoon):
    """``avatars(model, picture)``, each built once."""
    made = {}

    def get(name, picture):
        if (name, picture) not in made:
            made[name, picture] = make_avatar(*cartoon(picture), model=models(name), texture_size=SIZE, hair=False)
        return made[name, picture]

    return get


@pytest.mark.parametrize(
    ("name", "picture"), [("skin", "bad_guy"), *((name, picture) for name in ("surrey", "ict") for picture in PICTURES)]
)
def test_the_aligned_face_meets_the_picture_and_carries_it(avatars, cartoon, name, picture):
    avatar, (_, landmarks) = avatars(name, picture), cartoon(picture)
    assert max(avatar.report.aligned.values()) < 0.01 < max(avatar.report.coarse.values())
    # At rest the mouth, the jaw and the wings of the nose may be elsewhere; brows, bridge and eyes are not.
    found = avatar.face.project(avatar.vertices()[avatar.face.landmark_vertices])
    unit = np.linalg.norm(landmarks[45] - landmarks[36])
    still = np.r_[17:31, 36:48]
    assert np.linalg.norm(found[still] - landmarks[still], axis=1).max() < 0.01 * unit
    picture_of_it = avatar.render(avatar.pose, size=128)
    assert len(np.unique(picture_of_it.reshape(-1, 3), axis=0)) > 500
    assert not np.array_equal(picture_of_it, avatar.render(avatar.pose, size=128, textured=False))


@pytest.mark.parametrize("name", ["skin", "surrey", "ict"])
def test_files_hold_what_there_is(avatars, models, name, tmp_path):
    avatar = avatars(name, "bad_guy")
    for suffix in (".glb", ".obj", ".ply", ".html"):
        avatar.save(tmp_path / f"face{suffix}")
    assert [mesh["name"] for mesh in read_glb(tmp_path / "face.glb").json["meshes"]] == ["head"]
    back = load_avatar(tmp_path / "face.glb", model=models(name))
    size = np.ptp(avatar.vertices(), axis=0).max()
    np.testing.assert_allclose(back.vertices(), avatar.vertices(), atol=1e-6 * size)
    np.testing.assert_array_equal(back.texture, avatar.texture)
    assert back.names == avatar.names and back.report.warnings == avatar.report.warnings
    np.testing.assert_allclose(read_obj(tmp_path / "face.obj").vertices, avatar.vertices(), atol=1e-5 * size)


def test_what_is_missing_is_said(avatars):
    said = " ".join(avatars("skin", "bad_guy").report.warnings)
    for part in ("expressions", "eyeballs", "teeth", "inside of the mouth", "texture coordinates", "blinks"):
        assert f"the model has no {part}" in said


def test_a_rig_without_expressions_rests(avatars):
    avatar = avatars("skin", "bad_guy")
    assert avatar.names == () and avatar.rig.deltas.shape == (0, *avatar.vertices().shape) and avatar.pose == {}
    np.testing.assert_array_equal(avatar.vertices({"eyeLookUpLeft": 1.0}), avatar.vertices())
    with pytest.raises(ValueError, match="weights: no expression 'jawOpen'"):
        avatar.vertices({"jawOpen": 1.0})
    with pytest.raises(ValueError, match="side: expected an eyeball of the model, which has 0, got 1"):
        avatar.eye_vertices(1)


def test_a_vrm_needs_eyeballs(avatars, tmp_path):
    with pytest.raises(ValueError, match="avatar: expected one with eyeballs for .vrm"):
        avatars("skin", "bad_guy").save(tmp_path / "face.vrm")


def test_players_get_all_the_names_they_look_for(avatars, tmp_path):
    avatars("skin", "bad_guy").save(tmp_path / "face.glb", names="arkit", texture=None)
    (head,) = read_glb(tmp_path / "face.glb").json["meshes"]
    assert len(head["extras"]["targetNames"]) == 52


def test_the_drawn_eyes_are_on_the_skin_where_no_eyeball_lies_behind(avatars, models):
    # The Surrey model's eyes are skin. In the picture of the blonde girl they are blue.
    avatar = avatars("surrey", "blonde_girl_threequarter")
    model = models("surrey")
    u, v = (SIZE * (model.uv[model.landmarks[36:42]] * [1, -1] + [0, 1])).T
    eye = avatar.texture[int(v.min()) : int(v.max()) + 1, int(u.min()) : int(u.max()) + 1].astype(int)
    assert (eye[..., 2] > eye[..., 0] + 60).mean() > 0.25


def test_shapes_that_follow_the_gaze_are_the_gaze(avatars, models):
    avatar = avatars("ict", "moustache_man")
    assert set(GAZE_NAMES) <= set(models("ict").expression_names) and not set(GAZE_NAMES) & set(avatar.names)
    assert all(np.abs(shape).max() > 1 for shape in avatar.rig.gaze)
    opened = avatar.vertices({"jawOpen": 1.0}) - avatar.vertices()
    chin = avatar.face.landmark_vertices[8]
    assert opened[chin, 1] < -5


def test_each_part_is_missed_for_itself(model):
    assert missing_parts(model) == []
    assert len(missing_parts(replace(model, uv=np.zeros((0, 2)), uv_faces=np.zeros((0, 3), int)))) == 1
    assert len(missing_parts(replace(model, quads=np.zeros((0, 4), int)))) == 1
    without_tongue = {name: mask for name, mask in model.regions.items() if name != "tongue"}
    assert missing_parts(replace(model, regions=without_tongue)) == ["the model has no teeth and tongue"]
    # None of the named ones is named: no expressions, and no blinks among them.
    assert len(missing_parts(replace(model, n_named=0))) == 2


@pytest.mark.parametrize("part", ["sockets", "named", "cavity"])
def test_a_head_without_one_part_keeps_the_others(model, cartoon, part):
    changes = {
        "sockets": {"regions": {name: mask for name, mask in model.regions.items() if "socket" not in name}},
        "named": {"n_named": 0},
        "cavity": {"regions": {name: mask for name, mask in model.regions.items() if name != "mouth_cavity"}},
    }
    avatar = make_avatar(*cartoon("bad_guy"), model=replace(model, **changes[part]), texture_size=64, hair=False)
    assert len(avatar.report.warnings) in (1, 2) and len(avatar.surfaces()) == 3
    # The eyeballs lie behind the lids: beside the middle of each opening, not before it.
    for side, corners in enumerate(([42, 45], [36, 39])):
        middle = avatar.vertices()[avatar.face.landmark_vertices[corners]].mean(0)
        offset = avatar.eyes.centres[side] - middle
        assert offset[2] < 0 and np.linalg.norm(offset[:2]) < 0.5 * avatar.eyes.radii[side]
