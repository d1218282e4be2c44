"""Steps of a visit to the landmark editor."""

import shutil

import numpy as np

from tests.conftest import PORTRAITS
from toongeo.io import read_landmarks
from toongeo.protocols import LandmarkDetection

NAME = "moustache_man"
TRUTH = read_landmarks(PORTRAITS / f"{NAME}.pts")
READY = {"wait": "document.querySelector('[data-ready]') && toongeo.fits() > 0"}
POINTS = {"run": "toongeo.points()"}
SELECTED = {"run": "toongeo.selection()"}
SCALE = {"run": "toongeo.scale()"}
SURFACE = "[data-id=surface]"


def found(img):
    """What the detector that stands in for a real one finds: the truth, the jaw hardly sure."""
    return LandmarkDetection(TRUTH, np.where(np.arange(68) < 17, 0.25, 0.95), 1.0)


def a_picture(folder, name="face.png"):
    shutil.copy(PORTRAITS / f"{NAME}.png", folder / name)
    return folder


def text(part):
    """A script: what a part of the page says."""
    return f"document.querySelector('[data-id={part}]').textContent"


def says(part, beginning):
    return {"wait": f"{text(part)}.startsWith('{beginning}')"}


def button(part):
    return {"click": f"[data-id={part}]"}


def press(key, on=SURFACE):
    return {"key": key, "on": on}


def at(k):
    """A script: the place of a point on the screen."""
    return f"toongeo.screen({k})"


def at_px(x, y):
    """A script: the place of a pixel of the picture on the screen."""
    return f"toongeo.pixel([{x}, {y}])"


def results(report):
    """What the runs gave that gave something."""
    return [result for result in report["results"] if result is not None]
