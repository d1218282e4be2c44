import numpy as np
import pytest

from toongeo.pipeline.texture.sample_area import sample_area


def test_a_linear_ramp_is_exact_in_the_interior(rng):
    rows, columns = np.mgrid[:64, :64]
    ramp = np.stack([2.0 * columns - rows, 0.5 * rows + 3], 2)
    px, footprint = 24 + 16 * rng.random((200, 2)), 0.2 + 8 * rng.random(200)
    expected = np.column_stack([2 * px[:, 0] - px[:, 1], 0.5 * px[:, 1] + 3])
    np.testing.assert_allclose(sample_area(ramp, px, footprint), expected, atol=1e-10)


def test_a_checkerboard_finer_than_the_footprint_is_grey(rng):
    board = 255 * (np.indices((64, 64)).sum(0) % 2).astype(np.uint8)
    grey = sample_area(board, 8 + 48 * rng.random((100, 2)), np.full(100, 2.0))
    np.testing.assert_allclose(grey, 127.5, atol=1e-4)


def test_up_to_a_pixel_nothing_is_filtered(rng):
    img = rng.random((9, 9))
    rows, columns = np.mgrid[:9, :9]
    px = np.column_stack([columns.ravel(), rows.ravel()])
    np.testing.assert_array_equal(sample_area(img, px, np.ones(81)), img.ravel())


def test_outside_and_in_an_odd_last_row_the_border_goes_on():
    """Of 3 x 3 pixels the last 2 x 2 mean is the corner four times, that of 1 x 2 beside it two pixels twice."""
    img = np.array([[1.0, 2, 4], [8, 16, 32], [64, 128, 256]])
    px = np.array([[2.5, 2.5], [0.5, 0.5], [2.5, 0.5], [0.5, 2.5], [40, 40], [-9, 0.5]])
    expected = [256, (1 + 2 + 8 + 16) / 4, (4 + 32) / 2, (64 + 128) / 2, 256, (1 + 2 + 8 + 16) / 4]
    np.testing.assert_allclose(sample_area(img, px, np.full(6, 2.0)), expected)
    np.testing.assert_allclose(sample_area(img, px, np.ones(6))[-2:], [256, (1 + 8) / 2])


def test_footprints_are_checked():
    with pytest.raises(ValueError, match="footprint: expected 1 positive numbers"):
        sample_area(np.ones((4, 4)), np.zeros((1, 2)), np.zeros(1))
