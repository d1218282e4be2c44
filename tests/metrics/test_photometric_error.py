"""Photometric error: exact by construction."""

import numpy as np
import pytest

from toongeo.metrics import photometric_error

ALL = np.ones((20, 30), bool)


@pytest.fixture
def picture(rng):
    return rng.integers(20, 200, (20, 30, 3), dtype=np.uint8)


def test_zero_for_the_same_picture(picture):
    assert photometric_error(picture, picture, ALL) == 0.0


@pytest.mark.parametrize("shift", [(1, 0, 0), (5, -7, 11), (-20, -20, 55)])
def test_a_constant_offset_is_the_sum_of_its_channels(picture, shift):
    moved = (picture.astype(int) + shift).astype(np.uint8)
    assert photometric_error(moved, picture, ALL) == np.abs(shift).sum()


def test_greatest_value_and_symmetry(picture, rng):
    black, white = np.zeros_like(picture), np.full_like(picture, 255)
    assert photometric_error(black, white, ALL) == photometric_error(white, black, ALL) == 765.0
    other = rng.integers(0, 255, picture.shape, dtype=np.uint8)
    assert photometric_error(other, picture, ALL) == photometric_error(picture, other, ALL)


def test_only_the_mask_counts_and_halves_average(picture, rng):
    other = rng.integers(0, 255, picture.shape, dtype=np.uint8)
    upper = np.arange(20)[:, None] < 10 + 0 * np.arange(30)
    halves = [photometric_error(other, picture, half) for half in (upper, ~upper)]
    assert photometric_error(other, picture, ALL) == pytest.approx(np.mean(halves), rel=1e-12)
    assert photometric_error(np.where(upper[..., None], picture, other), picture, upper) == 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rendered": np.zeros((20, 30, 3))}, r"rendered: expected uint8 \(H, W, 3\), got float64"),
        ({"picture": np.zeros((20, 30), np.uint8)}, r"picture: expected uint8 \(H, W, 3\), got uint8 \(20, 30\)"),
        ({"rendered": np.zeros((20, 31, 3), np.uint8)}, r"rendered: expected shape \(20, 30, 3\) as picture has"),
        ({"mask": np.ones((20, 30))}, r"mask: expected bool \(20, 30\), got float64"),
        ({"mask": np.ones((30, 20), bool)}, r"mask: expected bool \(20, 30\), got bool \(30, 20\)"),
        ({"mask": ~ALL}, "mask: expected at least one pixel, got none"),
    ],
)
def test_bad_input_is_named(picture, change, message):
    with pytest.raises(ValueError, match=message):
        photometric_error(**({"rendered": picture, "picture": picture, "mask": ALL} | change))
