"""Renders with exact landmarks, drawn from seeds that nothing was trained on."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[3] / "data_templates" / "build"))

SEED = 99


@pytest.fixture(scope="session")
def render():
    """``render(k, kind)`` -> a render of a person (or another kind) with air around the head."""
    from renders import render_face

    return lambda k, kind="person", style="photo", size=320: render_face(
        np.random.default_rng([SEED, k]), kind, style, size, (0.11, 0.14)
    )
