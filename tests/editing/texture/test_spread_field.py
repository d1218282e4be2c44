import numpy as np

from toongeo.editing.texture.spread_field import spread_field


def test_keeps_what_is_known_and_fills_within_its_range(rng):
    field = rng.random((37, 53, 2)).astype(np.float32)
    known = rng.random((37, 53)) < 0.03
    filled = spread_field(field, known)
    assert (filled[known] == field[known]).all()
    assert filled.min() >= field[known].min() - 1e-6
    assert filled.max() <= field[known].max() + 1e-6


def test_a_constant_stays_constant(rng):
    known = rng.random((40, 30)) < 0.01
    known[7, 5] = True
    assert np.allclose(spread_field(np.full((40, 30, 1), 2.5, np.float32), known), 2.5)


def test_nothing_known_is_nothing():
    assert (spread_field(np.ones((8, 9, 2), np.float32), np.zeros((8, 9), bool)) == 0).all()
