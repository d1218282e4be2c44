"""Tests of the two cuts on a head drawn by hand in flat colours."""

import cv2
import numpy as np
import pytest

from toongeo.colour.cielab import cielab
from toongeo.pipeline.parse.hair.cuts import colour_cut, edge_cut, grab_cut
from toongeo.pipeline.parse.hair.plain_ground import plain_ground
from toongeo.pipeline.parse.hair.segment_hair import alike
from toongeo.pipeline.parse.working_view import WorkingView


@pytest.fixture
def picture(zones, cap, rng):
    """Dark hair, light skin, green ground, a little noise; and a posterior that is blurred and too large."""
    pixels = np.full((*cap.shape, 3), (90, 170, 110), np.uint8)
    pixels[zones.skull] = 230, 190, 160
    pixels[cap] = 60, 40, 30
    pixels = np.clip(pixels + rng.normal(0, 1, pixels.shape), 0, 255).astype(np.uint8)
    rough = cv2.dilate(cap.astype(np.float32), np.ones((9, 9), np.uint8))
    posterior = np.clip(cv2.GaussianBlur(rough, (0, 0), 4), 0.02, 0.95)
    height, width = cap.shape
    return WorkingView(pixels, np.zeros(2, int), np.array([width, height]), 180.0), posterior


def overlap(one, two):
    return (one & two).sum() / (one | two).sum()


def test_both_cuts_follow_the_outline_that_the_picture_shows(picture, zones, cap):
    view, posterior = picture
    assert overlap(posterior > 0.5, cap) < 0.92
    for ground in (None, plain_ground(view, zones)):
        assert overlap(colour_cut(cielab(view.pixels), zones, posterior, ground), cap) > 0.98
        assert overlap(grab_cut(view, zones, posterior, ground), cap) > 0.98


def test_the_edges_alone_tell_where_the_posterior_does_not(picture, cap):
    """Also where hair and wall have the same colour, but for the line between them."""
    view, _ = picture
    posterior = cv2.GaussianBlur(np.roll(cap, 2, 0).astype(np.float32), (0, 0), 6)
    assert overlap(edge_cut(cielab(view.pixels), posterior), cap) > 0.97
    line = cv2.morphologyEx(cap.astype(np.uint8), cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)) > 0
    lab = np.where(line, 40.0, 20.0)[..., None] * np.float32([1, 0, 0])
    assert overlap(edge_cut(lab.astype(np.float32), posterior), cap) > 0.93  # either side of the line is an edge


def test_nothing_likely_has_no_edges(picture):
    view, posterior = picture
    assert not edge_cut(cielab(view.pixels), posterior * np.float32(0.5)).any()


def test_a_mask_that_strays_is_outvoted(cap):
    near, far = np.roll(cap, 1, 0), ~cap
    for masks in ([cap, near, far], [far, cap, near], [near, far, cap]):
        assert {id(mask) for mask in alike(masks)} == {id(cap), id(near)}


def test_a_plain_ground_is_what_surrounds_the_head(picture, zones, cap):
    view, _ = picture
    ground = plain_ground(view, zones)
    assert overlap(ground, ~(zones.skull | cap)) > 0.97
    noise = np.random.default_rng(0).integers(0, 255, view.pixels.shape).astype(np.uint8)
    assert plain_ground(WorkingView(noise, view.corner, view.size, view.head), zones) is None


def test_nothing_likely_gives_nothing(picture, zones):
    view, posterior = picture
    low = np.full_like(posterior, 0.02)
    assert not colour_cut(cielab(view.pixels), zones, low, None).any()
    assert not grab_cut(view, zones, low, None).any()
