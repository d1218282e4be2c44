"""Weights between a notebook's code and its page: the side of the code."""

import sys

import numpy as np
import pytest

from toongeo import AvatarWidget


@pytest.fixture
def widget(avatar):
    pytest.importorskip("anywidget", reason="needs the extra `notebook`")
    return AvatarWidget(avatar, {"jawOpen": 0.25}, texture=None)


def test_weights_go_both_ways(widget, avatar):
    assert widget.weights == {"jawOpen": 0.25}
    heard = []
    widget.on_change(heard.append)
    widget.weights = {"browInnerUp": 0.5}
    assert widget.weights == {"browInnerUpLeft": 0.5, "browInnerUpRight": 0.5} == heard[-1]
    widget.widget.set_state({"weights": {**widget.widget.weights, "mouthLeft": 0.75}})  # as the page does
    assert heard[-1] == {"browInnerUpLeft": 0.5, "browInnerUpRight": 0.5, "mouthLeft": 0.75} == widget.weights
    avatar.vertices(widget.weights)
    widget.weights = np.eye(54)[50]
    assert list(widget.weights.values()) == [1.0]
    with pytest.raises(ValueError, match="jawOpne"):
        widget.weights = {"jawOpne": 1}
    assert len(widget.widget.weights) == 54 and "page" in widget.widget.settings


def test_without_the_extra(avatar, monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(ImportError, match='AvatarWidget needs the extra notebook: pip install "anywidget'):
        AvatarWidget(avatar, texture=None)
