"""A folder of OBJ files, one a target."""

import re

import numpy as np
import pytest

from toongeo.io import read_image, read_obj, write_obj_sequence


def test_every_target_is_a_file_of_the_same_faces(tmp_path, scene):
    write_obj_sequence(tmp_path / "out", scene, stem="x-1")
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert names[:3] == ["000_neutral.obj", "001_jawOpen.obj", "002_nothing.obj"]
    assert all(re.fullmatch(r"[\w.-]+", name, re.ASCII) for name in names) and len(names) == 1 + 4 + 2
    neutral = read_obj(tmp_path / "out" / "000_neutral.obj")
    np.testing.assert_allclose(neutral.vertices, np.vstack([m.vertices for m in scene.meshes]), atol=1e-5)
    jaw = read_obj(tmp_path / "out" / "001_jawOpen.obj")
    np.testing.assert_array_equal(jaw.faces, neutral.faces)
    np.testing.assert_array_equal(jaw.uv_faces, neutral.uv_faces)
    moved = np.vstack([m.moved({"jawOpen": 1.0}) for m in scene.meshes])
    np.testing.assert_allclose(jaw.vertices, moved, atol=1e-5)
    np.testing.assert_array_equal(read_image(tmp_path / "out" / "x-1_texture.png"), scene.meshes[0].texture)


def test_a_second_time_replaces_the_files(tmp_path, scene):
    write_obj_sequence(tmp_path, scene)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    write_obj_sequence(tmp_path, scene)
    assert before == {path.name: path.read_bytes() for path in tmp_path.iterdir()}


def test_where_nothing_can_be_written_nothing_is(tmp_path, scene):
    with pytest.raises(ValueError, match=r"stem: expected letters, digits, - and _, got '\.\./x'"):
        write_obj_sequence(tmp_path / "out", scene, stem="../x")
    with pytest.raises(OSError, match="cannot write to .*no"):
        write_obj_sequence(tmp_path / "no" / "out", scene)
    assert not list(tmp_path.iterdir())
    (tmp_path / "file").write_text("kept")
    with pytest.raises(OSError, match="cannot write to .*file"):
        write_obj_sequence(tmp_path / "file", scene)
    assert (tmp_path / "file").read_text() == "kept"
    (tmp_path / "blocked" / "000_neutral.obj").mkdir(parents=True)
    with pytest.raises(OSError, match="it is a folder"):
        write_obj_sequence(tmp_path / "blocked", scene)
    assert len(list((tmp_path / "blocked").iterdir())) == 1
