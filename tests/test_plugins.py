"""Parts by name, from packages that are installed."""

import sys

import numpy as np
import pytest

from toongeo.avatar.make_avatar import make_avatar
from toongeo.pipeline.landmarks.detect_landmarks import detect_landmarks
from toongeo.plugins import plugin, plugin_names
from toongeo.testing.example import example

MODULE = """
import numpy as np
from toongeo.protocols import LandmarkDetection

class Detector:
    def __call__(self, img):
        return [LandmarkDetection(np.add(np.arange(136).reshape(68, 2) % 17, 3.0), np.ones(68), 1.0)]

ready = Detector()

def made():
    return Detector()

def detect(img):
    return ready(img)
"""
ENTRIES = """
[toongeo.plugins]
detector.class = someones_plugin:Detector
detector.object = someones_plugin:ready
detector.maker = someones_plugin:made
detector.function = someones_plugin:detect
parser.broken = someones_plugin:nothing
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package as pip installs it."""
    (tmp_path / "someones_plugin.py").write_text(MODULE)
    info = tmp_path / "someones_plugin-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: someones-plugin\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRIES)
    monkeypatch.syspath_prepend(str(tmp_path))
    yield
    sys.modules.pop("someones_plugin", None)


def test_names_are_told_without_importing_anything(package):
    assert plugin_names("detector") == ["class", "function", "maker", "object"]
    assert plugin_names("parser") == ["broken"] and plugin_names("hair") == []
    assert "someones_plugin" not in sys.modules


@pytest.mark.parametrize("name", ["class", "object", "maker", "function"])
def test_a_detector_by_name(package, name):
    found = detect_landmarks(np.zeros((40, 40, 3), np.uint8), detector=name)
    np.testing.assert_array_equal(found.points[0], [3.0, 4.0])


def test_unknown_names_are_refused(package):
    with pytest.raises(ValueError, match=r"detector: expected one of .*class, function, maker, object.*, got 'none'"):
        plugin("none", "detector")
    with pytest.raises(ValueError, match="detector: expected one of"):
        make_avatar(np.array(example()[0]), detector="none")
    with pytest.raises(ValueError, match="parser: expected one of"):
        make_avatar(*map(np.array, example()), parser="none", texture_size=64)
    with pytest.raises(AttributeError):
        plugin("broken", "parser")
