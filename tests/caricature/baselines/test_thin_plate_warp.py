import numpy as np
import pytest

from toongeo.caricature import thin_plate_warp


def test_no_motion_is_the_picture(rng):
    img = rng.integers(0, 256, (50, 60, 3)).astype(np.uint8)
    points = rng.uniform(10, 40, (8, 2))
    assert (thin_plate_warp(img, points, points) == img).all()


def test_points_arrive(rng):
    yy, xx = np.mgrid[:80, :80]
    source = np.array([[30.0, 30.0], [50.0, 45.0]])
    target = source + [[4.0, 2.0], [-3.0, 3.0]]
    img = np.dstack([3 * xx, 3 * yy, 0 * xx]).astype(np.uint8)  # colours tell places
    moved = thin_plate_warp(img, source, target)
    for start, end in zip(source.astype(int), target.astype(int), strict=True):
        assert np.abs(moved[end[1], end[0]].astype(int) - img[start[1], start[0]]).max() <= 3


def test_bad_points():
    img, points = np.zeros((9, 9, 3), np.uint8), np.zeros((4, 2))
    with pytest.raises(ValueError, match="target: expected points"):
        thin_plate_warp(img, points, points[:3])
    with pytest.raises(ValueError, match="expected finite pixels"):
        thin_plate_warp(img, points, points * np.nan)
