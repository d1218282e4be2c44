"""Options of the classical parser."""

import pytest

from toongeo.pipeline import ClassicalParser


@pytest.mark.parametrize("size", [10, float("nan")])
def test_a_head_too_small_to_cut_is_refused(size):
    with pytest.raises(ValueError, match="head_px: expected at least 64"):
        ClassicalParser(head_px=size)


def test_the_smallest_head():
    assert ClassicalParser(head_px=64).head_px == 64
    with pytest.raises(ValueError, match="head_px: expected at least 64, got 63.9"):
        ClassicalParser(head_px=63.9)
