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
    fields = np.dstack([lab, np.zeros(lab.shape[:2], np.float32)])
    np.testing.assert_allclose(in_palette(fields, COLOURS, np.zeros(3, np.float32)), lab - 1, atol=0.01)


def test_colours_of_hair_and_others_keep_to_their_places():
    hair = np.zeros((40, 50), np.float32)
    hair[:20] = 1
    fields = np.dstack([picture(5), hair]).astype(np.float32)
    owners = np.array([-1e5, 1e5, 1e5], np.float32)  # the first colour is the hair's, the others are not
    found = in_palette(fields, COLOURS, owners)
    np.testing.assert_allclose(found[:20], np.broadcast_to(COLOURS[0], (20, 50, 3)), atol=0.01)
    assert np.abs(found[20:] - COLOURS[0]).max(axis=-1).min() > 30
