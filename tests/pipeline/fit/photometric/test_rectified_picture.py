"""The picture on a grid of the face's own frame."""

import numpy as np
import pytest

from toongeo.pipeline.fit.frame.canonical_frame import CanonicalFrame
from toongeo.pipeline.fit.photometric.rectified_picture import rectified_picture

STEP = 2.0
FRAME = CanonicalFrame(1.0, np.eye(3), np.array([100.0, 120.0]), np.eye(3))
FACE = np.array([[-30.0, -50.0], [30.0, 20.0]])  # mm, y up


@pytest.fixture
def rectified():
    return rectified_picture(np.zeros((240, 200, 3), np.uint8), None, FRAME, FACE, step=STEP, blur=1.0)


def test_the_grid_has_a_margin_of_12_mm_on_all_sides(rectified):
    rows, columns = rectified.confidence.shape
    right, bottom = rectified.left + STEP * (columns - 1), rectified.top - STEP * (rows - 1)
    assert (rectified.left, right, rectified.top, bottom) == (-42.0, 42.0, 32.0, -62.0)
    np.testing.assert_array_equal(rectified.grid(FACE[1:]), [[36, 6]])


def test_confidence_is_1_in_the_picture_and_0_outside():
    small = CanonicalFrame(1.0, np.eye(3), np.array([20.0, 20.0]), np.eye(3))
    found = rectified_picture(np.zeros((60, 40, 3), np.uint8), None, small, FACE, step=STEP, blur=1.0)
    rows, columns = found.confidence.shape
    x = 20 + found.left + STEP * np.arange(columns)
    y = 20 - (found.top - STEP * np.arange(rows))
    expected = ((x >= -0.5) & (x <= 39.5)) & ((y >= -0.5) & (y <= 59.5))[:, None]
    np.testing.assert_array_equal(found.confidence, expected)
