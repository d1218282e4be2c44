"""A process that goes on for long does not grow."""

import sys

import pytest

from tests.conftest import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))
import drift

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="memory in use is read from /proc")


@pytest.mark.slow
def test_a_hundred_fits_do_not_grow():
    before, after = drift.drift(drift.works()["fits"], 100)
    assert after - before < drift.MOST_MB


def test_growth_is_noticed():
    kept = []  # of blocks so large that no memory which was given back serves for them
    before, after = drift.drift(lambda k: kept.append(bytearray(b"x" * (40 << 20))), 10)
    assert after - before > drift.MOST_MB
