"""Exports of a part of the head, read back from the files."""

import numpy as np
import pytest

from toongeo.avatar.crop_faces import crop_faces
from toongeo.avatar.scene import avatar_scene
from toongeo.io import read_glb, read_obj, split_seams


def scene(avatar, crop):
    return avatar_scene(avatar, crop=crop, split=False)


@pytest.mark.parametrize("crop", ["head", "bust"])
def test_head_and_bust_are_the_whole_template(avatar, crop):
    head = scene(avatar, crop).meshes[0]
    np.testing.assert_array_equal(head.vertices, avatar.rig.neutral)
    np.testing.assert_array_equal(head.faces, avatar.faces)
    np.testing.assert_array_equal(head.targets, np.concatenate([avatar.rig.deltas, avatar.rig.gaze]))


def test_a_face_is_the_same_triangles_with_the_same_corners_uv_and_targets(avatar):
    model, mesh = avatar.face.model, scene(avatar, "face").meshes[0]
    kept = crop_faces(model, "face")
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], avatar.rig.neutral[model.faces[kept]])
    np.testing.assert_array_equal(mesh.uv[mesh.uv_faces], model.uv[model.uv_faces[kept]])
    np.testing.assert_array_equal(mesh.targets[:46, mesh.faces], avatar.rig.deltas[:, model.faces[kept]])
    np.testing.assert_array_equal(np.unique(mesh.faces), np.arange(len(mesh.vertices)))  # nothing idle
    outside = model.region("scalp") | model.region("ears") | model.region("neck")
    assert not outside[model.faces[kept]].any()
    assert np.isin(model.landmarks[17:], model.faces[kept]).all()


def test_the_skin_of_a_face_has_one_clean_edge(model):
    """Every edge of the face is shared by two triangles or lies on a border, and each border is a simple loop."""
    faces = model.faces[crop_faces(model, "face")]
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    assert count.max() == 2
    border = unique[count == 1]
    assert set(np.unique(border, return_counts=True)[1]) == {2}


def test_files_of_a_face_read_back(avatar, node, tmp_path):
    expected = scene(avatar, "face")
    for suffix in (".glb", ".obj", ".ply"):
        avatar.save(tmp_path / f"face{suffix}", crop="face")
    document = read_glb(tmp_path / "face.glb").json
    assert [mesh["name"] for mesh in document["meshes"]] == ["head", "teeth", "tongue", "eye_left", "eye_right"]
    assert len(document["meshes"][0]["extras"]["targetNames"]) == 54
    np.testing.assert_array_equal(
        read_obj(tmp_path / "face.obj").vertices, np.vstack([mesh.vertices for mesh in expected.meshes])
    )
    header = (tmp_path / "face.ply").read_bytes()[:400].decode("latin-1")
    points = sum(len(split_seams(mesh.faces, mesh.uv_faces)[0]) for mesh in expected.meshes)
    assert f"element vertex {points}\n" in header
    (verdict,) = node("validate.mjs", tmp_path / "face.glb")
    assert (verdict["errors"], verdict["warnings"]) == (0, 0), verdict


def test_an_unknown_crop_is_refused(avatar, tmp_path):
    with pytest.raises(ValueError, match="crop: expected one of head, bust, face, got 'torso'"):
        avatar.save(tmp_path / "a.glb", crop="torso")
    assert not list(tmp_path.iterdir())
