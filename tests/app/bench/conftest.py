"""Two bundled pictures in a folder of their own."""

import shutil

import numpy as np
import pytest

from tests.conftest import PORTRAITS
from toongeo.io import read_landmarks

NAMES = ("blue_girl", "moustache_man")


@pytest.fixture
def folder(tmp_path):
    """One with ``.pts``, the other with ``.txt`` beside it."""
    pictures = tmp_path / "pictures"
    pictures.mkdir()
    for name in NAMES:
        shutil.copy(PORTRAITS / f"{name}.png", pictures)
    shutil.copy(PORTRAITS / "blue_girl.pts", pictures)
    np.savetxt(pictures / "moustache_man.txt", read_landmarks(PORTRAITS / "moustache_man.pts"), fmt="%.6f")
    return pictures
