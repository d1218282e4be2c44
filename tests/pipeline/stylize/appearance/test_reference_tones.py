"""Flat tones of drawings."""

import numpy as np

from toongeo.pipeline.stylize.appearance.reference_tones import in_tones, tones_of

COLOURS = np.array([[35, 10, 5], [60, 12, 14], [85, 4, 20]], np.float32)


def flat(rng, count=4000):
    return COLOURS[rng.choice(3, count, p=(0.2, 0.5, 0.3))] + rng.normal(size=(count, 3)).astype(np.float32) * 0.5


def test_flat_tones_are_counted(rng):
    found = tones_of(flat(rng))
    np.testing.assert_allclose(found.colours, COLOURS, atol=0.3)


def test_shaded_parts_have_none(rng):
    assert tones_of((rng.normal(size=(5000, 3)) * [9, 3, 3] + [60, 10, 10]).astype(np.float32)) is None


def test_a_ramp_takes_the_tones_in_their_order(rng):
    ramp = np.zeros((20, 300, 3), np.float32)
    ramp[..., 0] = np.linspace(10, 50, 300)
    drawn = in_tones(ramp, ramp[..., 0].ravel().astype(float), tones_of(flat(rng)))
    for k, column in enumerate((30, 150, 270)):
        np.testing.assert_allclose(drawn[:, column], np.broadcast_to(COLOURS[k], (20, 3)), atol=0.5)
    assert (np.abs(drawn[:, :, None] - COLOURS).max(axis=-1).min(axis=-1) < 1).mean() > 0.9
