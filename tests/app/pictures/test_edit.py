"""The same picture with another expression, from the command line."""

import numpy as np
import pytest

from tests.conftest import PORTRAITS
from toongeo.app.cli import main
from toongeo.editing import ExpressionEditor
from toongeo.io import read_image
from toongeo.model import preset

PICTURE, POINTS = PORTRAITS / "moustache_man.png", PORTRAITS / "moustache_man.pts"


@pytest.fixture
def editor(avatar, cartoon, monkeypatch):
    """The editor of that picture, whose face is taken to smile already; it keeps what was asked for."""
    shown = {"mouthSmileLeft": 0.5, "jawOpen": 0.2}
    ready = ExpressionEditor(*cartoon("moustache_man"), avatar=avatar, pose=shown)
    asked = []

    def frame(weights):
        asked.append(dict(weights) if isinstance(weights, dict) else np.array(weights))
        return np.zeros((8, 8, 3), np.uint8)

    monkeypatch.setattr(ready, "frame", frame)
    monkeypatch.setattr("toongeo.app.pictures.edit.ExpressionEditor", lambda img, points: ready)
    return ready, asked


def edited(tmp_path, *more):
    return main(["edit", str(PICTURE), "--landmarks", str(POINTS), "-o", str(tmp_path / "out.png"), *more])


def test_weights_are_added_to_what_the_picture_shows(editor, tmp_path, capsys):
    """Else a smile on a smiling face would be less of one."""
    ready, asked = editor
    names = ready.avatar.names
    assert edited(tmp_path, "--smile", "0.5", "--weights", "jawOpen=-0.1", "mouthPucker=0.25") == 0
    (weights,) = asked
    added = preset("smile", 0.5)
    for name in ("mouthSmileLeft", "mouthSmileRight", "cheekSquintLeft"):
        shown = ready.pose[names.index(name)]
        assert weights[names.index(name)] == pytest.approx(shown + added.get(name, 0))
        assert weights[names.index(name)] > shown
    assert weights[names.index("jawOpen")] == pytest.approx(0.2 - 0.1)
    assert weights[names.index("mouthPucker")] == 0.25
    np.testing.assert_array_equal(weights[len(names) :], ready.pose[len(names) :])
    assert f"wrote {tmp_path / 'out.png'}" in capsys.readouterr().out
    assert read_image(tmp_path / "out.png").shape == (8, 8, 3)


def test_no_more_is_taken_than_is_there(editor, tmp_path):
    ready, asked = editor
    assert edited(tmp_path, "--weights", "jawOpen=-0.9", "--weights", "mouthPucker=-1") == 0
    names = ready.avatar.names
    assert asked[0][names.index("jawOpen")] == 0 and asked[0][names.index("mouthPucker")] == 0


def test_absolute_weights_are_the_whole_expression(editor, tmp_path):
    _, asked = editor
    assert edited(tmp_path, "--absolute", "--weights", "jawOpen=0.2", "AU26=0.4") == 0
    assert asked == [{"jawOpen": pytest.approx(0.4)}]
    assert edited(tmp_path, "--absolute") == 0 and asked[1] == {}
