"""A mask in one piece: what touches the core, without small holes."""

import cv2
import numpy as np
import pytest
from scipy.ndimage import label

from toongeo.pipeline.parse.head_and_skin import _one_piece


@pytest.mark.parametrize("seed", range(5))
def test_it_is_what_its_pieces_say(seed):
    noise = np.random.default_rng(seed).random((120, 160))
    mask = cv2.GaussianBlur(noise, (0, 0), 3) > 0.5
    core = np.zeros_like(mask)
    core[30:90, 40:100] = True
    pieces, n = label(mask, np.ones((3, 3)))
    touching = np.isin(pieces, np.setdiff1d(pieces[core], 0))
    holes, n_holes = label(~touching)
    small = [k for k in range(1, n_holes + 1) if (holes == k).sum() < 0.02 * core.sum()]
    assert n > 1 and 1 <= len(small) < n_holes
    np.testing.assert_array_equal(_one_piece(mask, core), touching | np.isin(holes, small))


@pytest.mark.parametrize(("area", "filled"), [(49, True), (50, False)])
def test_a_hole_of_a_fiftieth_of_the_core_stays(area, filled):
    mask = np.ones((70, 70), bool)
    mask[0] = False  # the outside
    mask[10, 5 : 5 + area] = False
    core = np.zeros_like(mask)
    core[15:65, 10:60] = True
    assert _one_piece(mask, core)[10, 5] == filled
