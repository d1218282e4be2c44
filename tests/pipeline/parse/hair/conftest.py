"""A head drawn by hand."""

import numpy as np
import pytest

from toongeo.pipeline.parse.hair.head_zones import HeadZones

HEIGHT, WIDTH, HEAD = 300, 240, 180.0
CHIN, BROWS = 200, 110  # rows


@pytest.fixture(scope="session")
def zones():
    y, x = np.mgrid[:HEIGHT, :WIDTH].astype(np.float32)
    skull = ((x - 120) / 60) ** 2 + ((y - 115) / 85) ** 2 < 1
    up = (BROWS - y) / (CHIN - BROWS)
    hull = skull & (up < 0)
    brow = (abs(y - BROWS) < 3) & (abs(abs(x - 120) - 25) < 15)
    core = ((x - 120) / 48) ** 2 + ((y - 150) / 45) ** 2 < 1
    none = np.zeros_like(skull)
    return HeadZones(
        skull=skull,
        ears=none,
        hull=hull,
        core=core,
        plain=core,
        brow=brow,
        crown=skull & (up > 0.3),
        across=(x - 120) / (CHIN - BROWS),
        up=up,
        chin=np.array([120.0, CHIN]),
        head=HEAD,
        unit=70.0,
    )


@pytest.fixture
def cap(zones):
    """Hair of a crown that is thicker than the skull."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    return (((x - 120) / 70) ** 2 + ((y - 110) / 100) ** 2 < 1) & (y < 80)
