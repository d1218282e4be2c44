"""Colours from places in the atlas and light."""

import numpy as np

from toongeo.colour.srgb import linear_to_srgb
from toongeo.render.frames.paint import encoded, planes_on, shaded
from toongeo.render.sample_image import sample_image


def test_colours_are_those_of_the_atlas_times_light_and_of_the_ground_where_nothing_is():
    rng = np.random.default_rng(0)
    atlas = rng.random((20, 30, 3), np.float32)
    values = rng.random((40, 50, 6), np.float32) * np.float32([29, 19, 1, 1, 1, 1])
    nothing = rng.random((40, 50)) < 0.3
    ground = np.float32([3, 4, 0.5, 1, 1, 9])
    for channels in (3, 6):
        planes = planes_on(ground[:channels], values[:, :, :channels], nothing)
        filled = np.where(nothing[:, :, None], ground, values)
        light = filled[:, :, 2:3] if channels == 3 else filled[:, :, 2:5]
        expected = sample_image(atlas, filled[:, :, :2].reshape(-1, 2)).reshape(40, 50, 3) * light
        np.testing.assert_allclose(shaded(atlas, planes), expected, atol=0.07)  # 1/32 of a texel, of two axes


def test_encoding_rounds_and_light_beyond_white_is_white():
    linear = np.linspace(0, 1.5, 30_000, dtype=np.float32)
    exact = 255 * linear_to_srgb(np.minimum(linear, 1))
    assert np.abs(encoded(linear) - exact).max() < 0.56  # half a step, and a twentieth
