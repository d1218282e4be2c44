"""The editor in a notebook: what the kernel hears and answers."""

import sys

import numpy as np
import pytest

from toongeo import LandmarkEditor

IMG = np.full((300, 300, 3), 200, np.uint8)


@pytest.fixture
def heard(monkeypatch):
    """A function that asks an editor as its page would, and gives reply and buffers."""
    pytest.importorskip("anywidget", reason="needs the extra `notebook`")

    def ask(editor, question, message=None):
        sent = []
        monkeypatch.setattr(type(editor.widget), "send", lambda widget, *reply: sent.append(reply))
        editor.widget._handle_custom_msg({"id": 7, "question": question, "message": message or {}}, [])
        ((reply, buffers),) = sent
        assert reply.pop("id") == 7
        return reply, buffers

    return ask


def test_points_come_and_go(heard, truth):
    editor = LandmarkEditor(IMG, truth)
    np.testing.assert_array_equal(editor.landmarks, truth)
    reply, buffers = heard(editor, "open", {"picture": 0})
    np.testing.assert_array_equal(reply["answer"]["points"], truth)
    assert buffers == []
    moved = [None, *(truth[1:] + 1).tolist()]
    heard(editor, "save", {"picture": 0, "points": moved, "suffix": ".pts"})
    assert np.isnan(editor.landmarks[0]).all()
    np.testing.assert_array_equal(editor.landmarks[1:], truth[1:] + 1)
    editor.landmarks[:] = 0  # a copy
    assert editor.landmarks[1, 0] != 0


def test_picture_settings_and_errors(heard, detector):
    editor = LandmarkEditor(IMG, detector=detector)
    assert editor.landmarks is None
    reply, (picture,) = heard(editor, "picture", {"picture": 0})
    assert reply == {} and picture[:3] == b"\xff\xd8\xff"
    assert heard(editor, "open", {"picture": 0})[0]["answer"]["source"] == "detected"
    assert "expected a number below 1" in heard(editor, "open", {"picture": 1})[0]["error"]
    assert editor.widget.settings["isWidget"] and len(editor.widget.settings["names"]) == 68
    assert "application/vnd.jupyter.widget-view+json" in editor._repr_mimebundle_()[0]


def test_what_is_no_picture_and_no_landmarks(truth):
    with pytest.raises(ValueError, match=r"img: expected \(H, W, 3\) uint8"):
        LandmarkEditor(IMG / 255)
    with pytest.raises(ValueError, match="landmarks: expected 68 points"):
        LandmarkEditor(IMG, truth[:51])


def test_without_anywidget_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(ImportError, match='pip install "anywidget>='):
        LandmarkEditor(IMG)
