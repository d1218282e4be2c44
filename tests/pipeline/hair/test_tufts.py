import numpy as np

from toongeo.pipeline.hair.plane.working_plane import CELL_MM
from toongeo.pipeline.hair.shell.tufts import between_tufts

BOARD = np.ones((40, 160), bool)


def test_a_board_ends_in_tufts():
    """What goes is a run upwards from the lowest cell of each column, of at most 11 mm, of another length elsewhere."""
    gone = between_tufts(BOARD, np.zeros_like(BOARD))
    depth = gone.sum(axis=0)
    np.testing.assert_array_equal(gone, np.arange(40)[:, None] < depth)
    assert depth.max() * CELL_MM <= 11.0 + CELL_MM
    inner = depth[20:-20]
    assert inner.min() * CELL_MM < 4.0 < 9.0 < inner.max() * CELL_MM
    assert (np.abs(np.diff(depth)) <= 2).all()  # no steps


def test_tufts_begin_beside_strands_that_hang_lower():
    """Above a strand nothing goes, beside it little: a hole there would show the neck."""
    hair, strand = BOARD.copy(), np.zeros_like(BOARD)
    hair[:10], strand[:12, 60:100] = False, True
    gone = between_tufts(hair, strand)
    assert not gone[:, 60:100].any()
    assert gone[:, [58, 59, 100, 101]].sum(axis=0).max() <= 2
    assert gone[:, :40].any() and gone[:, 120:].any()
    assert not (gone & ~hair).any()


def test_no_hair_no_tufts():
    assert not between_tufts(np.zeros_like(BOARD), BOARD).any()
