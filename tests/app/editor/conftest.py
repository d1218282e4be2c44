"""A picture in a folder of its own, and a detector that stands in for a real one."""

import shutil

import numpy as np
import pytest

from tests.conftest import PORTRAITS
from toongeo.protocols import LandmarkDetection

NAME = "moustache_man"


@pytest.fixture
def folder(tmp_path):
    """A folder with one picture and no landmarks."""
    shutil.copy(PORTRAITS / f"{NAME}.png", tmp_path / "face.png")
    return tmp_path


@pytest.fixture(scope="session")
def truth(cartoon):
    """(68, 2) px of that picture."""
    return cartoon(NAME)[1]


@pytest.fixture(scope="session")
def detector(truth):
    """Finds the picture's own landmarks, the first half of them hardly sure."""
    confidence = np.where(np.arange(68) < 34, 0.25, 0.95)
    return lambda img: LandmarkDetection(truth, confidence, 1.0)
