"""Few colours."""

import numpy as np

from toongeo.pipeline.stylize.appearance.palette import in_palette, palette_of

COLOURS = np.array([[20, 0, 0], [60, 30, 10], [90, -20, 40]], np.float32)


def picture(seed=0):
    rng = np.random.default_rng(seed)
    return COLOURS[rng.choice(3, (40, 50), p=(0.5, 0.3, 0.2))]


def test_the_colours_of_a_flat_picture_are_found():
    lab = picture()
    found = palette_of(lab, np.ones(lab.shape[:2], np.float32), 3)
    order = np.argsort(found[:, 0])
    np.testing.assert_allclose(found[order], COLOURS, atol=1e-4)
    assert len(palette_of(lab, np.ones(lab.shape[:2], np.float32), 8)) == 3  # there are no more


def test_neither_order_nor_side_counts():
    lab = picture(1) + np.random.default_rng(3).normal(size=(40, 50, 3)).astype(np.float32) * 3
    weight = np.random.default_rng(4).uniform(size=(40, 50)).astype(np.float32)
    one = palette_of(lab, weight, 5)
    np.testing.assert_allclose(palette_of(lab[:, ::-1], weight[:, ::-1], 5), one, atol=1e-3)


def test_what_has_no_weight_has_no_colour():
    lab = picture(2)
    weight = (lab[..., 0] < 50).astype(np.float32)
    np.testing.assert_allclose(palette_of(lab, weight, 3), COLOURS[:1], atol=1e-4)


def test_each_pixel_takes_the_nearest_colour():
    lab = picture(3) + np.float32(1)
    distances = np.stack([np.square(lab - colour).sum(-1) for colour in COLOURS])
    np.testing.assert_allclose(in_palette(distances, COLOURS), lab - 1, atol=0.01)
