"""Tests of what hair can be, on a head drawn by hand."""

import numpy as np

from toongeo.pipeline.parse.hair.growth_rules import growth_rules

HEIGHT, WIDTH = 300, 240
BROWS = 110  # row


def ruled(mask, zones):
    return growth_rules(mask, zones, mask.astype(np.float32))


def test_a_crown_stays_as_it_is(zones, cap):
    found = ruled(cap, zones)
    assert (found ^ cap).sum() < 0.01 * cap.sum()


def test_the_given_mask_is_not_written_to(zones, cap):
    before = cap.copy()
    ruled(cap, zones)
    np.testing.assert_array_equal(cap, before)


def test_brows_go_unless_hair_falls_into_them(zones, cap):
    assert not (ruled(cap | zones.brow, zones) & zones.brow).any()
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    fringe = (abs(x - 100) < 8) & (y >= 70) & (y < 118)
    found = ruled(cap | zones.brow | fringe, zones)
    assert found[BROWS, 100] and not (found & zones.brow)[:, 135:].any()


def test_shoulders_go_and_hanging_hair_stays(zones, cap):
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    strands = (abs(abs(x - 120) - 66) < 12) & (y >= 60) & (y < 270)
    coat = (y > 225) & (abs(x - 120) < 30)
    found = ruled(cap | strands | coat, zones)
    assert found[260, 54] and found[260, 186] and not found[240:, 110:130].any()


def test_hair_below_the_chin_alone_is_none(zones, cap):
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    coat = (y > 215) & (abs(x - 120) < 90)
    np.testing.assert_array_equal(ruled(cap | coat, zones), ruled(cap, zones))


def test_a_collar_that_hangs_by_a_thread_goes(zones, cap):
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    thread = (abs(x - 186) < 3) & (y >= 60) & (y < 230)
    collar = (y > 205) & (y < 260) & (abs(x - 186) < 40)
    found = ruled(cap | thread | collar, zones)
    assert not found[215:].any()


def test_small_holes_close_and_crumbs_go(zones, cap):
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    hole = np.hypot(y - 40, x - 120) < 5
    crumb = np.hypot(y - 20, x - 20) < 3
    np.testing.assert_array_equal(ruled(cap & ~hole | crumb, zones), ruled(cap, zones))


def test_nothing_gives_nothing(zones):
    assert not ruled(np.zeros((HEIGHT, WIDTH), bool), zones).any()
