"""Shapes that are painted."""

import numpy as np

from toongeo.pipeline.stylize.strokes.canvas import Canvas, colour
from toongeo.pipeline.stylize.strokes.curves import curve, faired, taper


def blank(side=40):
    return Canvas(np.zeros((side, side, 3), np.float32))


def test_the_cover_of_a_rectangle_is_its_area():
    canvas = blank()
    corners = np.array([[5.25, 7.5], [20.5, 7.5], [20.5, 30.25], [5.25, 30.25]])
    canvas.polygon(corners, (1, 1, 1))
    np.testing.assert_allclose(canvas.rgb[..., 0].sum(), 15.25 * 22.75, rtol=0.05)
    assert canvas.rgb.min() == 0 and canvas.rgb.max() == 1


def test_a_ribbon_has_its_width_and_bends_do_not_cancel_out():
    canvas = blank(80)
    line = np.stack([np.linspace(10, 70, 60), np.full(60, 40.0)], axis=1)
    canvas.ribbon(line, 3.0, (1, 1, 1))
    np.testing.assert_allclose(canvas.rgb[:, 40, 0].sum(), 6, atol=0.5)
    loop = 40 + 4 * np.stack([np.cos(np.linspace(0, 6, 50)), np.sin(np.linspace(0, 6, 50))], axis=1)
    bent = blank(80)
    bent.ribbon(loop, 4.5, (1, 1, 1))  # wider than its radius
    assert bent.rgb[40, 40, 0] == 1


def test_paint_keeps_within_the_picture_and_its_mask():
    canvas = blank()
    within = np.zeros((40, 40), np.float32)
    within[:20] = 1
    square = np.array([[-30.0, -30], [90, -30], [90, 90], [-30, 90]])
    canvas.polygon(square, (8, 8, 8), 0.5, within=within)
    assert (canvas.rgb[:20] == 4).all() and (canvas.rgb[20:] == 0).all()
    before = canvas.rgb.copy()
    canvas.polygon(square + 200, (9, 9, 9))
    np.testing.assert_array_equal(canvas.rgb, before)


def test_the_given_picture_is_not_written_to():
    picture = np.zeros((9, 9, 3), np.float32)
    Canvas(picture).cover(np.ones((9, 9), np.float32), (5, 5, 5))
    assert not picture.any()


def test_curves_go_through_their_points_and_keep_their_ends():
    points = np.array([[0, 0], [3, 1], [4, 5], [9, 6.0]])
    line = curve(points, 10)
    np.testing.assert_allclose(line[::10], points)
    np.testing.assert_allclose(faired(line, 3)[[0, -1]], points[[0, -1]], atol=1e-9)
    straight = np.stack([np.arange(30.0), 2 * np.arange(30.0)], axis=1)
    np.testing.assert_allclose(faired(straight, 5), straight, atol=1e-9)
    assert taper(11, 0.2, 0.2)[[0, 5, 10]].tolist() == [0, 1, 0]


def test_grey_is_grey():
    r, g, b = colour(53.4)
    assert abs(r - g) < 1 and abs(g - b) < 1 and 120 < r < 135
