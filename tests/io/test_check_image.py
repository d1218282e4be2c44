"""What is no picture is called by its name."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from toongeo.io import check_image

PIXELS = np.zeros((2, 3, 3), np.uint8)


@pytest.mark.parametrize(
    ("img", "got"),
    [
        (PIXELS.astype(float), r"float64 of shape \(2, 3, 3\)"),
        (PIXELS[..., 0], r"uint8 of shape \(2, 3\)"),
        (PIXELS[:0], r"uint8 of shape \(0, 3, 3\)"),
        (PIXELS.tolist(), r"list of int64 of shape \(2, 3, 3\)"),
        (Image.fromarray(PIXELS), r"a picture of Pillow: np.asarray\(face.convert\('RGB'\)\) is its array"),
        (Path("me.png"), r"a path: read_image\('me.png'\) reads it"),
        ("me.png", r"a path: read_image\('me.png'\) reads it"),
        (None, r"NoneType of object of shape \(\)"),
    ],
)
def test_what_came_is_named(img, got):
    with pytest.raises(ValueError, match=rf"^face: expected \(H, W, 3\) uint8 RGB, got {got}$"):
        check_image(img, "face")


def test_a_picture_is_one():
    check_image(PIXELS)
