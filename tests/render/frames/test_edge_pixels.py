"""Edges of a frame, and the faces that may show at them."""

import numpy as np

from toongeo.render.frames.edge_pixels import edge_pixels, faces_near


def test_an_edge_is_where_texture_or_depth_jumps_on_both_sides_of_it():
    places = np.zeros((3, 6, 8))
    places[0, :, 4:] = 6.5  # texels
    edges = np.zeros((6, 8), bool)
    edges[:, 3:5] = True
    np.testing.assert_array_equal(edge_pixels(*places, 0.5), edges)
    places[0] *= 0.9  # not far enough
    assert not edge_pixels(*places, 0.5).any()
    places[2, 3:] = -2.25  # of which 0.5 are a pixel's width
    edges = np.zeros((6, 8), bool)
    edges[2:4] = True
    np.testing.assert_array_equal(edge_pixels(*places, 0.5), edges)


def test_the_faces_near_are_those_whose_box_holds_an_edge_pixel():
    rng = np.random.default_rng(3)
    middles = rng.uniform(-10, 55, (30, 1, 2))
    px, faces = (middles + rng.normal(0, 4, (30, 3, 2))).reshape(90, 2), np.arange(90).reshape(30, 3)
    edges = rng.random((40, 50)) < 0.01
    low = np.rint(px[faces].min(axis=1)).astype(int)
    high = np.rint(px[faces].max(axis=1)).astype(int)
    y, x = np.nonzero(edges)
    slow = [((x >= a) & (x <= c) & (y >= b) & (y <= d)).any() for (a, b), (c, d) in zip(low, high, strict=True)]
    assert 3 < sum(slow) < 27
    np.testing.assert_array_equal(faces_near(px, faces, edges), np.flatnonzero(slow))
