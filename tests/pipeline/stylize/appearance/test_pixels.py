"""Edges, and pictures of other sizes."""

import numpy as np

from toongeo.pipeline.stylize.appearance.pixels import antialiased, hull_of, placed_in, reduced
from toongeo.pipeline.stylize.appearance.steep_edges import border_line, steep_edges


def ramp(slope, at):
    return (slope * (np.mgrid[:20, :40][1] - at)).astype(np.float32)


def test_the_cover_of_a_half_plane_is_its_area():
    for slope in (0.1, 1.0, 7.0):
        cover = antialiased(ramp(slope, 17.3), 1e-3)
        np.testing.assert_allclose(cover[5:-5].sum(axis=1), 39 - 17.3 + 0.5, atol=0.1)  # whatever the slope


def test_a_flat_field_has_a_soft_edge():
    assert 0.4 < antialiased(ramp(0.001, 20.0), 0.02)[10, 18] < 0.5


def test_points_stay_on_their_pixels():
    img = np.zeros((40, 40, 1), np.float32)
    img[12:14, 22:24] = 1
    small = reduced(img, 0.5)
    x, y = placed_in(np.array([[22.5, 12.5]]), 0.5)[0]
    assert small[int(y), int(x)] == 1 and (x, y) == (11.0, 6.0)


def test_the_border_of_a_mask_is_a_line_of_its_width():
    mask = np.clip(ramp(0.1, 20.0) + 0.5, 0, 1)
    np.testing.assert_allclose(border_line(mask, 2.0)[10].sum(), 4, atol=0.3)


def test_steep_edges_sharpen_steps_and_keep_levels():
    soft = np.clip(10 * ramp(1.0, 20.0) + 50, 0, 100)[..., None] * np.ones(3, np.float32)
    sharp = steep_edges(soft, 4)
    assert np.abs(np.diff(sharp[10, :, 0])).max() > 1.3 * np.abs(np.diff(soft[10, :, 0])).max()
    np.testing.assert_allclose(sharp[10, [0, -1]], soft[10, [0, -1]], atol=1e-3)


def test_hull():
    points = np.array([[0, 0], [4, 0], [4, 4], [0, 4], [2, 2.0]])
    assert sorted(map(tuple, hull_of(points))) == [(0, 0), (0, 4), (4, 0), (4, 4)]
