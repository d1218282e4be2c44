"""Teeth, gums, lashes and walls: what hangs on nothing moves as what it belongs to."""

import dataclasses

import numpy as np
import pytest

from toongeo.pipeline.rig.foreign.loose_parts import MouthParts, settle_loose_parts


def test_a_tooth_moves_with_its_row_and_does_not_bend(rng):
    skin, tooth, row = rng.normal(size=(20, 3)), rng.normal(size=(8, 3)) + 5, rng.normal(size=(30, 3)) + 5
    V = np.vstack([skin, tooth])
    F = np.vstack([[(k, k + 1, k + 2) for k in range(18)], [(20 + k, 21 + k, 22 + k) for k in range(6)]])
    shapes = rng.normal(0, 0.1, size=(3, 28, 3))
    of_row = np.arange(60) < 30
    drop = np.array([[0, -2.0, 0], [1, 0, 0], [0, 0, 0]])[:, None] * of_row[:, None]
    within = MouthParts(np.vstack([row, row + 100]), drop, of_row, (of_row, ~of_row))
    found = settle_loose_parts(V, F, np.full((68, 3), np.nan), shapes, np.arange(28) < 20, within)
    np.testing.assert_array_equal(found[:, :20], shapes[:, :20])
    np.testing.assert_allclose(found[:, 20:], np.broadcast_to(drop[:, :1], (3, 8, 3)), atol=1e-12)
    bent = dataclasses.replace(within, shapes=drop + rng.normal(0, 0.1, size=(3, 60, 3)))
    for shape in settle_loose_parts(V, F, np.full((68, 3), np.nan), shapes, np.arange(28) < 20, bent):
        pairs = [np.linalg.norm(x[:, None] - x, axis=2) for x in (tooth, tooth + shape[20:])]
        np.testing.assert_allclose(pairs[0], pairs[1], atol=1e-12)


@pytest.mark.parametrize("rows_below", [16, 10])
def test_gums_of_both_rows_bend_unless_they_are_mostly_of_one(rows_below):
    """A bar between two rows, of which one moves: each end follows its own, unless most of the bar is by one."""
    bar = np.c_[np.linspace(0, 1, 16), np.zeros((16, 2))]
    skin = np.c_[np.linspace(0, 1, 20), np.full((20, 2), 50.0)]
    F = np.vstack([[(k, k + 1, k + 2) for k in range(18)], [(20 + k, 21 + k, 22 + k) for k in range(14)]])
    below = np.repeat([True, False], [rows_below, 16 - rows_below])
    rows = np.vstack([bar, bar + [0, 0, 9]])
    of_row = np.r_[below, np.zeros(16, bool)], np.r_[~below, np.ones(16, bool)]
    drop = np.array([[[0.0, -2, 0]]]) * of_row[0][:, None]
    within = MouthParts(rows, drop, np.ones(32, bool), of_row)
    found = settle_loose_parts(
        np.vstack([skin, bar]), F, np.full((68, 3), np.nan), np.zeros((1, 36, 3)), np.arange(36) < 20, within
    )
    moved = np.ones(16, bool) if rows_below == 16 else below
    np.testing.assert_allclose(found[0, 20:], [0, -2, 0] * moved[:, None], atol=1e-12)


def test_what_is_mostly_outside_the_mouth_is_not_in_it(rng):
    """A part of which a third is nearest to the mouth bends with the skin around it."""
    skin, part = rng.normal(size=(20, 3)), np.c_[np.arange(9.0) + 20, np.zeros((9, 2))]
    F = np.vstack([[(k, k + 1, k + 2) for k in range(18)], [(20 + k, 21 + k, 22 + k) for k in range(7)]])
    mouth = np.arange(9) < 3
    within = MouthParts(part, np.ones((1, 9, 3)), mouth, (mouth,))
    shapes = np.zeros((1, 29, 3))
    found = settle_loose_parts(np.vstack([skin, part]), F, np.full((68, 3), np.nan), shapes, np.arange(29) < 20, within)
    assert not found.any()


def test_a_lash_moves_as_the_lid_it_grows_on():
    """A strip that stands on the edge of a plate and leans over it: all of it moves as the edge."""
    x, y = np.meshgrid(np.linspace(0, 4, 5), np.linspace(0, 8, 9), indexing="ij")
    plate = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])
    strip = np.array([[z, k, z] for k in range(1, 8) for z in (0.1, 1.0, 2.0, 3.0)])
    V = np.vstack([plate, strip])
    F = np.vstack([[(k, k + 1, k + 9) for k in range(36)], [(45 + k, 46 + k, 47 + k) for k in range(26)]])
    shapes = np.zeros((1, len(V), 3))
    shapes[0, :9, 1] = -1.0  # the edge x = 0
    within = MouthParts(plate, shapes[:, :45], np.zeros(45, bool), ())
    found = settle_loose_parts(V, F, np.full((68, 3), np.nan), shapes, np.arange(len(V)) < 45, within)
    np.testing.assert_array_equal(found[0, 45:], np.broadcast_to([0, -1.0, 0], (28, 3)))


def test_an_inner_wall_follows_the_outer_one(rng):
    """A sheet close behind another moves as it, place by place, and not as a part that stands on it."""
    grid = np.stack(np.meshgrid(np.arange(10.0), np.arange(10.0)), 2).reshape(-1, 2) * 20
    corner = np.add.outer(10 * np.arange(9), np.arange(9)).ravel()
    sheet = np.vstack([np.c_[corner, corner + 1, corner + 10], np.c_[corner + 1, corner + 11, corner + 10]])
    outer = np.c_[grid, np.zeros(100)]
    V = np.vstack([outer, outer - [0, 0, 1.0]])
    F = np.vstack([sheet, sheet[:, ::-1] + 100])
    shapes = np.zeros((2, 200, 3))
    shapes[:, :100] = 1e-4 * outer @ rng.normal(size=(2, 3, 3)) + rng.normal(0, 0.1, size=(2, 100, 3))
    within = MouthParts(np.full((1, 3), 1e6), np.zeros((2, 1, 3)), np.zeros(1, bool), ())
    found = settle_loose_parts(V, F, np.full((68, 3), np.nan), shapes, np.arange(200) < 100, within)
    np.testing.assert_allclose(found[:, 100:], shapes[:, :100], atol=1e-12)
