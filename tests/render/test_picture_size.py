"""Sizes of pictures that are to be drawn."""

import numpy as np
import pytest

from toongeo.render.picture_size import picture_size


@pytest.mark.parametrize(
    ("size", "expected"), [(512, (512, 512)), (np.int32(7), (7, 7)), ((2, 3), (2, 3)), ([4, np.uint8(5)], (4, 5))]
)
def test_sides(size, expected):
    assert picture_size(size) == expected


@pytest.mark.parametrize("size", [512.0, "512", None, True, (1, 2, 3), (1.5, 2), (), {}, (True, 4)])
def test_what_is_no_size(size):
    with pytest.raises(ValueError, match=r"size: expected positive \(height, width\) in px, or an integer, got"):
        picture_size(size)


@pytest.mark.parametrize("size", [0, -3, (0, 5), (5, -1)])
def test_sizes_that_are_not_positive(size):
    with pytest.raises(ValueError, match=r"size: expected positive \(height, width\) in px, got"):
        picture_size(size)


def test_sizes_beyond_memory():
    assert picture_size(5792, 2) == (5792, 5792)
    for size, supersample in ((40_000, 1), (5800, 2), ((2**40, 1), 1)):
        with pytest.raises(ValueError, match="size: expected at most as many pixels as"):
            picture_size(size, supersample)
