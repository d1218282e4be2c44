"""Tests of zones that follow the drawn head, and of what the cuts of head and skin say about hair."""

import numpy as np
import pytest

from toongeo.pipeline.parse.hair.cut_evidence import cut_evidence
from toongeo.pipeline.parse.hair.narrowed_zones import narrowed_zones
from toongeo.pipeline.parse.head_and_skin import HeadAndSkin
from toongeo.pipeline.parse.masks import grown


def ellipse(zones, across, up, breadth, height):
    """A head (h, w) in faces."""
    return ((zones.across - across) / breadth) ** 2 + ((zones.up - up) / height) ** 2 < 1


def cuts(head, skin):
    none = np.zeros_like(head)
    return HeadAndSkin(head, skin, np.where(skin, 0, 1).astype(np.float32), none)


def test_a_head_that_is_larger_changes_nothing(zones):
    found = narrowed_zones(zones, grown(zones.skull, 20))
    for name in ("skull", "ears", "crown"):
        np.testing.assert_array_equal(getattr(found, name), getattr(zones, name))


def test_nor_does_a_head_that_was_not_found(zones):
    assert narrowed_zones(zones, np.zeros_like(zones.skull)) is zones


def test_a_skull_comes_into_the_head_that_is_drawn(zones):
    """Here a lower and narrower one, off to one side."""
    head = ellipse(zones, 0.1, 0.0, 0.5, 0.7)
    found = narrowed_zones(zones, head)
    above = zones.up > 0.05
    assert (zones.skull & above & ~head).sum() > 500
    assert not (found.skull & above & ~grown(head, 1)).any()
    hair = 0.04 * zones.head
    assert (head & (zones.up > 0)).any(0).sum() - (found.skull & above).any(0).sum() >= 2 * hair - 4
    np.testing.assert_array_equal(found.crown, found.skull & (zones.up > 0.3))


def test_what_is_below_the_brows_keeps_its_height(zones):
    found = narrowed_zones(zones, ellipse(zones, 0, 0.0, 2, 0.5))
    low = zones.up < -0.02
    assert (found.skull != zones.skull)[~low].any()
    assert ((found.skull != zones.skull) & low).sum() < 0.02 * zones.skull.sum()


def test_zones_of_a_mirrored_head_are_mirrored(zones):
    head = ellipse(zones, 0.15, 0.0, 0.45, 0.7)
    found, other = narrowed_zones(zones, head).skull, narrowed_zones(zones, np.roll(head[:, ::-1], 1, 1)).skull
    assert (found != np.roll(other[:, ::-1], 1, 1)).sum() < 0.01 * found.sum()


def test_skin_is_no_hair_and_what_is_left_of_the_crown_is(zones, cap):
    head = zones.skull | cap
    skin = zones.skull & ~cap
    doubt = np.full(head.shape, 0.3, np.float32)
    found = cut_evidence(zones, cuts(head, skin), doubt)
    deep = grown(skin, -8)
    odds = np.log(found / (1 - found)) - np.log(0.3 / 0.7)
    np.testing.assert_allclose(odds[deep & (zones.up > -1)], -2.5, atol=1e-4)
    np.testing.assert_allclose(odds[grown(cap & (zones.up > 0) & ~zones.hull, -8)], 1.0, atol=1e-4)
    np.testing.assert_allclose(odds[~grown(head, 8)], 0.0, atol=1e-4)


@pytest.mark.parametrize("held", [True, False])
def test_a_head_without_its_hair_is_not_believed(zones, cap, held):
    """Dark hair before a dark wall: what the cut leaves above the brows is no hair then."""
    crown = cap & (zones.up > 0.3)
    head = (zones.skull & ~crown) | (crown if held else np.zeros_like(crown))
    posterior = np.where(crown, 0.9, 0.1).astype(np.float32)
    found = cut_evidence(zones, cuts(head, np.zeros_like(head)), posterior)
    left = grown(zones.skull & ~crown & (zones.up > 0), -3) & ~zones.hull
    assert left.any()
    assert (found[left] > 0.15).all() == held
