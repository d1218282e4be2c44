"""Tests of the small parts: colour evidence, soft edges, plain grounds, superpixels, trust."""

import dataclasses

import numpy as np
import pytest

from toongeo.colour.cielab import cielab
from toongeo.pipeline.parse.hair.colour_evidence import colour_evidence
from toongeo.pipeline.parse.hair.hair_alpha import hair_alpha
from toongeo.pipeline.parse.hair.hair_trust import (
    HairChances,
    HairCuts,
    HairMeasures,
    distrust,
    hair_measures,
    without_clothes,
)
from toongeo.pipeline.parse.hair.superpixels import superpixels

GOOD = HairMeasures(
    area=0.4,
    agreement=0.95,
    inside=0.95,
    outside=0.05,
    topped=1.0,
    border=0.0,
    hat=0.0,
    outlined=1.0,
    left=0.8,
    hanging=10.0,
)


def test_evidence_is_antisymmetric_in_its_sides(rng):
    lab = rng.uniform([0, -60, -60], [100, 60, 60], (20, 30, 3)).astype(np.float32)
    one, two = rng.random((2, 20, 30), np.float32)
    np.testing.assert_allclose(colour_evidence(lab, one, two), -colour_evidence(lab, two, one), atol=1e-5)


def test_evidence_speaks_for_the_side_that_has_the_colour():
    lab = np.zeros((10, 20, 3), np.float32)
    lab[:, 10:] = 80, 20, 20
    left = np.broadcast_to(np.arange(20) < 10, (10, 20)).astype(np.float32)
    found = colour_evidence(lab, left, 1 - left)
    assert (found[:, :10] > 3).all() and (found[:, 10:] < -3).all()


def test_soft_edges_follow_the_picture_and_leave_the_rest(rng):
    """A ragged mask comes nearer to the edge that the picture shows."""
    x = np.arange(80)
    img = np.broadcast_to(np.where(x < 40, 30, 230)[None, :, None], (60, 80, 3)).astype(np.uint8)
    mask = x < 40 + rng.integers(-2, 3, (60, 1))
    alpha = hair_alpha(img, mask, 180.0)
    assert (alpha[:, :33] == 1).all() and (alpha[:, 47:] == 0).all()
    truth = np.broadcast_to(x < 40, mask.shape)
    assert ((alpha > 0.5) != truth).sum() < 0.1 * (mask != truth).sum()


def test_superpixels_partition_the_picture_and_keep_its_mean(rng):
    img = rng.integers(0, 255, (40, 50, 3)).astype(np.uint8)
    patches = superpixels(cielab(img))
    assert set(np.unique(patches.labels)) == set(range(len(patches.area)))
    total = (patches.colours * patches.area[:, None]).sum(0) / patches.area.sum()
    np.testing.assert_allclose(total, cielab(img).mean((0, 1)), rtol=1e-4)


def test_the_way_is_that_of_the_smoothest_path():
    """Around a wall of another colour, not through it."""
    lab = np.zeros((60, 60, 3), np.float32)
    lab[:40, 24:36, 0] = 100
    patches = superpixels(lab)
    way = patches.way(patches.mean(np.broadcast_to(np.arange(60) < 6, (60, 60))) > 0.5)[patches.labels]
    assert way[5, 55] < 30 < 60 < way[5, 30]
    assert (patches.way(np.zeros(len(patches.area), bool)) == 200).all()


def test_measures_of_a_crown_that_is_known(zones, cap):
    """Two masks of which one is the upper half of the other; posterior 0.8 inside, 0.1 outside, a quarter of it hat."""
    posterior = np.where(cap, 0.8, 0.1).astype(np.float32)
    half = cap.copy()
    half[:45] = False
    lab = np.where(cap[..., None], np.float32([20, 0, 0]), np.float32([70, 10, 10]))
    found = hair_measures(lab, cap, HairCuts(cap, half, cap), zones, HairChances(posterior, posterior / 4))
    assert found.area == pytest.approx(cap.sum() / zones.head**2)
    assert found.agreement == pytest.approx(half.sum() / cap.sum())
    assert (found.inside, found.outside, found.hat) == pytest.approx((0.8, 0.1, 0.25), abs=1e-5)
    assert found.certainty == pytest.approx(found.agreement + 0.7 + 0.1)  # head less skin is just this
    assert found.topped == 1 and found.border == 0 and found.outlined == 1
    assert found.left == 1 and found.hanging == 10
    chances = HairChances(posterior, posterior)
    low = cap & (zones.up < 0.5)
    assert hair_measures(lab, low, HairCuts(low, low, cap), zones, chances).topped > 0.9
    side = cap & (zones.across < 0)
    halved = hair_measures(lab, side, HairCuts(side, side, cap), zones, chances)
    assert 0.4 < halved.topped < 0.6
    assert 0.5 < halved.outlined < 0.8  # no outline along the middle line


def test_measures_of_nothing(zones):
    nothing = np.zeros(zones.skull.shape, bool)
    field = np.full(nothing.shape, 0.2, np.float32)
    lab = np.zeros((*nothing.shape, 3), np.float32)
    found = hair_measures(lab, nothing, HairCuts(nothing, nothing, nothing), zones, HairChances(field, field))
    assert found.area == 0 and found.topped == 0 and distrust(found)


def test_good_measures_are_trusted_and_each_bad_one_is_named():
    assert distrust(GOOD) == ()
    bad = {
        "area": (0.0, "hardly any"),
        "agreement": (0.84, "disagree"),
        "inside": (0.64, "doubtful"),
        "outside": (0.4, "hard to tell"),
        "outlined": (0.8, "no outline"),
        "topped": (0.2, "top"),
        "border": (0.9, "border"),
        "hat": (0.8, "hat"),
        "hanging": (0.2, "clothes"),
    }
    for name, (value, word) in bad.items():
        # Of a clear case, so that no other limit is reached.
        clear = dataclasses.replace(GOOD, agreement=1.0, inside=1.0, outside=0.0)
        clear = clear if name != "outside" else GOOD
        (reason,) = distrust(dataclasses.replace(clear, **{name: value}))
        assert word in reason


@pytest.mark.parametrize("colour", [(20, 0, 0), (60, -30, -20)])
def test_a_collar_in_another_colour_than_the_hair_is_noticed(zones, cap, colour):
    """What hangs beside the chin: a strand of the hair, or the upper end of a coat."""
    hanging = (np.abs(zones.across + 0.6) < 0.15) & (zones.up < 0.3) & (zones.up > -1.1)
    coat = (zones.up < -1) & (np.abs(zones.across) < 1)
    lab = np.full((*cap.shape, 3), np.float32([90, 0, 0]))
    lab[coat] = 60, -30, -20
    lab[cap] = 20, 0, 0
    lab[hanging] = colour
    mask, field = cap | hanging, np.full(cap.shape, 0.5, np.float32)
    found = hair_measures(lab, mask, HairCuts(mask, mask, mask), zones, HairChances(field, field))
    assert (found.hanging > 0.5) == (colour == (20, 0, 0))


@pytest.mark.parametrize("colour", [(20, 0, 0), (60, -30, -20)])
def test_a_collar_is_taken_off_the_hair_and_a_strand_is_not(zones, cap, colour):
    hanging = (np.abs(zones.across + 0.6) < 0.15) & (zones.up < 0.3) & (zones.up > -1.1)
    coat = (zones.up < -1) & (np.abs(zones.across) < 1)
    lab = np.full((*cap.shape, 3), np.float32([90, 0, 0]))
    lab[coat], lab[cap], lab[hanging] = (60, -30, -20), (20, 0, 0), colour
    mask = cap | hanging
    kept = without_clothes(lab, mask, zones)
    expected = mask if colour == (20, 0, 0) else mask & (zones.up >= -0.6)
    np.testing.assert_array_equal(kept, expected)


def test_a_third_mask_makes_doubtful_cuts_certain():
    doubtful = dataclasses.replace(GOOD, agreement=0.92, inside=0.7, outside=0.15)
    assert distrust(doubtful)
    assert distrust(dataclasses.replace(doubtful, left=1.0)) == ()


@pytest.mark.parametrize("value", [np.nan])
def test_measures_that_are_no_numbers_are_not_trusted(value):
    assert distrust(dataclasses.replace(GOOD, agreement=value))
