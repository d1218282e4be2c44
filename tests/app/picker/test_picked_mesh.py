"""Which vertices are picked from: as the rig and as the loaders count them."""

import numpy as np
import pytest

from tests.model.loaders import layouts
from toongeo.app.picker.picked_mesh import picked_mesh, picked_model
from toongeo.io import Scene, SceneMesh, read_mesh, write_glb, write_obj
from toongeo.model import MorphableModel, load_model, save_model

TRIANGLE = np.array([[0, 1, 2]])


def test_meshes_of_a_file_are_counted_through(tmp_path):
    parts = [SceneMesh(name, np.eye(3) * 10 * k, TRIANGLE) for k, name in enumerate(("a", "b"), 1)]
    write_glb(tmp_path / "two.glb", Scene(tuple(parts)))
    mesh = picked_mesh(tmp_path / "two.glb")
    np.testing.assert_array_equal(
        mesh.vertices, np.vstack([p.vertices for p in read_mesh(tmp_path / "two.glb").meshes])
    )
    np.testing.assert_array_equal(mesh.faces, [[0, 1, 2], [3, 4, 5]])
    assert mesh.colours is None and mesh.landmarks is None


def test_a_texture_gives_colours(tmp_path):
    texture = np.zeros((2, 2, 3), np.uint8)
    texture[0, 0], texture[1, 0], texture[1, 1] = (255, 0, 0), (0, 255, 0), (0, 0, 255)  # row 0 is v = 1
    uv = np.array([[0.0, 0.999], [0.0, 0.0], [0.999, 0.0]])
    part = SceneMesh("a", np.eye(3), TRIANGLE, uv=uv, texture=texture)
    write_glb(tmp_path / "a.glb", Scene((part,)))
    np.testing.assert_array_equal(picked_mesh(tmp_path / "a.glb").colours, [[255, 0, 0], [0, 255, 0], [0, 0, 255]])


def test_a_model_is_its_mean(tmp_path):
    file = layouts.deep3d(layouts.Face(), tmp_path / "BFM_model_front.mat")
    mesh, model = picked_model(file), load_model(file)
    np.testing.assert_array_equal(mesh.vertices, model.mean)
    np.testing.assert_array_equal(mesh.landmarks, model.landmarks)
    np.testing.assert_array_equal(mesh.mirror, model.mirror)


def test_a_model_without_landmarks(tmp_path, model):
    bare = MorphableModel.from_arrays(model.mean + [40.0, 0, 0], model.faces)
    save_model(bare, tmp_path / "bare.npz")
    mesh = picked_model(tmp_path / "bare.npz")
    assert mesh.landmarks is None
    np.testing.assert_array_equal(mesh.mirror, model.mirror)  # its plane is found, not taken for x = 0


def test_a_mesh_that_is_no_model(tmp_path):
    write_obj(tmp_path / "a.obj", Scene((SceneMesh("a", np.eye(3), TRIANGLE),)))
    assert len(picked_model(tmp_path / "a.obj").vertices) == 3


def test_what_is_neither(tmp_path):
    (tmp_path / "a.png").write_bytes(b"\x89PNG and more")
    with pytest.raises(ValueError, match=r"path: expected a model of faces or a mesh .*toongeo landmarks"):
        picked_model(tmp_path / "a.png")
