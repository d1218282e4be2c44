"""Questions of the picker's page."""

import base64
import json
from dataclasses import replace

import numpy as np
import pytest

from toongeo.app.picker.picked_mesh import PickedMesh
from toongeo.app.picker.picker_session import PickerSession
from toongeo.model.ibug68 import MIRROR


@pytest.fixture
def mesh(model):
    return PickedMesh(model.mean, model.faces, mirror=model.mirror)


def test_the_mesh_goes_to_the_page(mesh, tmp_path):
    far = replace(mesh, vertices=mesh.vertices + [1e7, 0, 0])
    answer = PickerSession(far, "head.obj", tmp_path / "head.txt").answer("mesh", {})
    seen = np.frombuffer(base64.b64decode(answer["vertices"]), "<f4").reshape(-1, 3)
    size = np.ptp(mesh.vertices, axis=0).max()
    middle = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
    np.testing.assert_allclose(seen * size + middle, mesh.vertices, atol=1e-4)
    np.testing.assert_array_equal(np.frombuffer(base64.b64decode(answer["mirror"]), "<u4"), mesh.mirror)
    assert answer["start"] == [None] * 68 and answer["suffix"] == ".txt" and answer["colours"] is None
    json.dumps(answer)


def test_every_point_is_asked_for_once_and_one_side_first(mesh, tmp_path):
    order = PickerSession(mesh, "a", tmp_path / "a.json").settings()["order"]
    assert sorted(order) == list(range(68))
    first = order[: order.index(42)]  # the left eye begins
    assert {int(k) for k in MIRROR[first]} | set(first) == set(range(68))
    assert all(MIRROR[k] == k or MIRROR[k] not in first for k in first)


def test_save_and_go_on(mesh, tmp_path, model):
    table = [int(v) for v in model.landmarks]
    session = PickerSession(mesh, "a", tmp_path / "a.json")
    (tmp_path / "a.txt").write_text("of the user")
    assert session.answer("save", {"vertices": table, "suffix": ".txt"}) == {"exists": "a.txt"}
    assert (tmp_path / "a.txt").read_text() == "of the user"
    assert session.answer("save", {"vertices": table, "suffix": ".json"}) == {"file": "a.json"}
    assert session.answer("save", {"vertices": [None] + table[1:], "suffix": ".json"}) == {"file": "a.json"}
    again = PickerSession(mesh, "a", tmp_path / "a.json")
    assert again.answer("mesh", {})["start"] == [None] + table[1:]
    assert again.answer("save", {"vertices": table, "suffix": ".json"}) == {"file": "a.json"}  # it was gone on with
    started = PickerSession(mesh, "a", tmp_path / "b.json", tmp_path / "a.json")
    assert started.answer("mesh", {})["start"] == table


def test_an_output_that_is_something_else_is_told_and_kept(mesh, tmp_path):
    (tmp_path / "a.json").write_text('{"scene": 1}')
    session = PickerSession(mesh, "a", tmp_path / "a.json")
    answer = session.answer("mesh", {})
    assert answer["start"] == [None] * 68 and "expected a list of 68 entries" in answer["note"]
    assert session.answer("save", {"vertices": [1] * 68, "suffix": ".json"}) == {"exists": "a.json"}
    with pytest.raises(ValueError, match="expected a list of 68 entries"):
        PickerSession(mesh, "a", tmp_path / "b.json", tmp_path / "a.json")


@pytest.mark.parametrize(
    ("message", "text"),
    [
        ({"vertices": [0] * 67, "suffix": ".json"}, "vertices: expected a list of 68 vertices, got 67 entries"),
        ({"vertices": "x", "suffix": ".json"}, "vertices: expected a list of 68 vertices, got x"),
        ({"vertices": [10**9] + [0] * 67, "suffix": ".json"}, "or null, got 1000000000 for point 0"),
        ({"vertices": [-1] + [0] * 67, "suffix": ".json"}, "or null, got -1 for point 0"),
        ({"vertices": [True] + [0] * 67, "suffix": ".json"}, "or null, got True for point 0"),
        ({"vertices": [1.5] + [0] * 67, "suffix": ".json"}, "or null, got 1.5 for point 0"),
        ({"vertices": [None] * 68, "suffix": ".json"}, "all are missing"),
        ({"vertices": [0] * 68, "suffix": "/../x.json"}, "suffix: expected .json or .txt"),
    ],
)
def test_what_cannot_be_saved(mesh, tmp_path, message, text):
    session = PickerSession(mesh, "a", tmp_path / "a.json")
    with pytest.raises(ValueError, match=text):
        session.answer("save", message)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("question", ["open", "", "../mesh"])
def test_what_is_not_asked(mesh, tmp_path, question):
    session = PickerSession(mesh, "a", tmp_path / "a.json")
    with pytest.raises(ValueError, match="question: expected one of mesh, save"):
        session.answer(question, {})
    with pytest.raises(ValueError, match="picture: expected none"):
        session.shown_picture(0)
