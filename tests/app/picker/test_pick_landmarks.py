"""``toongeo landmarks head.obj`` and ``toongeo model pick``: the way to the page, and what is refused before it."""

import json

import numpy as np
import pytest

from toongeo.app.cli import main
from toongeo.app.editor.editor_server import EditorServer
from toongeo.io import Scene, SceneMesh, write_obj
from toongeo.model import save_model


@pytest.fixture
def served(monkeypatch):
    """The sessions that would be served until Ctrl+C."""
    sessions = []
    monkeypatch.setattr(EditorServer, "serve_forever", lambda server: sessions.append(server.session))
    return sessions


@pytest.fixture
def head(tmp_path):
    write_obj(tmp_path / "head.obj", Scene((SceneMesh("a", np.eye(3), np.array([[0, 1, 2]])),)))
    return tmp_path / "head.obj"


def test_a_mesh_opens_the_picker(head, served, capsys):
    assert main(["landmarks", str(head), "--no-open"]) == 0
    assert main(["model", "pick", str(head), "--no-open", "-o", str(head.with_name("points.txt"))]) == 0
    said = capsys.readouterr().out
    assert "picker: http://127.0.0.1:" in said and "head.json" in said and "points.txt" in said
    assert [session.title for session in served] == ["head.obj"] * 2
    served[0].answer("save", {"vertices": [1] * 68, "suffix": ".json"})
    assert json.loads(head.with_name("head.json").read_text()) == [1] * 68


def test_a_model_opens_it_with_its_landmarks(tmp_path, model, served):
    save_model(model, tmp_path / "m.npz")
    assert main(["model", "pick", str(tmp_path / "m.npz"), "--no-open"]) == 0
    assert served[0].answer("mesh", {})["start"] == model.landmarks.tolist()


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["landmarks", "{head}", "-o", "{folder}/x.pts"], "--output: expected a name that ends in .json or .txt"),
        (["landmarks", "{folder}/none.obj"], "none.obj: No such file"),
        (["landmarks", "{folder}/m.npz"], "for a model of faces: toongeo model pick"),
        (["model", "pick", "{folder}/none.npz"], "none.npz: No such file"),
        (["model", "pick", "{folder}/face.png"], "for a picture: toongeo landmarks"),
        (["model", "pick", "{head}", "--landmarks", "{head}"], "--landmarks: expected .json"),
        (["landmarks", "{folder}/broken.ply"], "PATH: expected a mesh file"),
    ],
)
def test_what_is_refused(head, tmp_path, served, capsys, arguments, text):
    (tmp_path / "face.png").write_bytes(b"\x89PNG")
    (tmp_path / "broken.ply").write_bytes(b"ply\nand no more")
    filled = [word.format(head=head, folder=tmp_path) for word in arguments]
    assert main([*filled, "--no-open"]) == 2
    assert text in capsys.readouterr().err and not served
