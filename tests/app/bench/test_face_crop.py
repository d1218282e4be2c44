"""The crop and its camera show the same place."""

import numpy as np
import pytest

from toongeo.app.bench.face_crop import PAPER, face_crop
from toongeo.metrics import face_square
from toongeo.render import ScaledOrthographicCamera


def square(centre, side):
    """Landmarks whose crop has the side and, but for the forehead, the centre."""
    half = side / 1.7 / 2
    return np.array(centre) + np.vstack([[[-half, -half], [half, half]], np.zeros((66, 2))])


@pytest.mark.parametrize("side", [60.0, 130.0, 224.0, 611.7])
def test_a_blob_lies_where_the_camera_projects_it(side):
    place, spread = np.array([163.3, 201.8]), side / 20
    y, x = np.mgrid[:420, :380]
    blob = 250 * np.exp(-((x - place[0]) ** 2 + (y - place[1]) ** 2) / (2 * spread**2))
    img = np.repeat(np.rint(blob).astype(np.uint8)[..., None], 3, axis=2)
    crop = face_crop(img, square([165, 190], side))
    camera = crop.camera(ScaledOrthographicCamera(1.0, np.eye(3), place))
    weight = np.where(crop.inside, crop.pixels[..., 0], 0).astype(float)
    rows, columns = np.mgrid[: len(weight), : len(weight)]
    centre = [(columns * weight).sum() / weight.sum(), (rows * weight).sum() / weight.sum()]
    assert camera.project(np.zeros((1, 3)))[0] == pytest.approx(centre, abs=0.05)


def test_the_crop_is_the_square_of_the_metric():
    points = square([50, 60], 80)
    corner, side = face_square(points)
    crop = face_crop(np.zeros((100, 100, 3), np.uint8), points)
    assert crop.scale == pytest.approx(224 / side)
    # The square begins at the edge of a pixel.
    assert crop.corner == pytest.approx(corner - 0.5 + 0.5 / crop.scale)


def test_what_lies_beyond_the_picture_is_told():
    crop = face_crop(np.zeros((40, 100, 3), np.uint8), square([50, 20], 80))
    assert (crop.pixels[~crop.inside] > 0).any() and not crop.pixels[crop.inside].any()
    assert (crop.pixels[0] == PAPER).all() and not crop.inside[0].any()
    rows = crop.inside.any(axis=1).sum()
    assert rows == pytest.approx(39 * crop.scale, abs=1)
