"""Rims of glasses, dark and light."""

import cv2
import numpy as np
import pytest

from toongeo.pipeline.texture.find_rims import find_rims


def with_glasses(img, points, colour):
    """The picture with thin round rims and a bridge."""
    worn = img.copy()
    middles = [points[part].mean(axis=0) for part in (range(36, 42), range(42, 48))]
    width = np.linalg.norm(points[39] - points[36])
    for middle in middles:
        cv2.circle(
            worn, tuple(np.rint(middle * 16).astype(int).tolist()), round(12.8 * width), colour, 2, cv2.LINE_AA, 4
        )
    ends = [middle + sign * np.array([0.8 * width, 0]) for middle, sign in zip(middles, (1, -1), strict=True)]
    cv2.line(worn, *(tuple(np.rint(end).astype(int).tolist()) for end in ends), colour, 2, cv2.LINE_AA)
    return worn, middles, 0.8 * width


@pytest.mark.parametrize(("colour", "light"), [((70, 50, 40), False), ((255, 250, 245), True)])
def test_rims_run_where_they_were_drawn(cartoon, colour, light):
    img, points = cartoon("astronaut")
    worn, middles, radius = with_glasses(img, points, colour)
    rims = find_rims(worn, points)
    assert rims is not None and rims.light == light
    for line, middle in zip(rims.lines, middles, strict=False):
        off = np.abs(np.linalg.norm(line - middle, axis=1) - radius)
        assert np.median(off) < 0.06 * radius
        assert (line[20:40, 1] > middle[1]).all()


def test_without_glasses_there_are_none(cartoon):
    for name in ("astronaut", "beethoven", "moustache_man", "bad_guy"):
        assert find_rims(*cartoon(name)) is None, name
