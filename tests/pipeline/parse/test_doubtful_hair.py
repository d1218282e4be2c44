"""Tests of the hair that labels show where no mask of it is trusted."""

from types import SimpleNamespace

import numpy as np
import pytest

from toongeo.pipeline.parse.doubtful_hair import doubtful_hair

DARK, RED = (30, 20, 20), (200, 20, 20)


@pytest.fixture
def scene():
    """A head of 100 px with dark hair, a strand beside the cheek, and a coat of two colours, one the hair's."""
    y, x = np.mgrid[:240, :200]
    skull = ((x - 100) / 40) ** 2 + ((y - 90) / 50) ** 2 < 1
    hull = skull & (y > 70)
    cap = (((x - 100) / 50) ** 2 + ((y - 90) / 60) ** 2 < 1) & ~hull & (y < 150)
    strand = (x > 140) & (x < 150) & (y >= 95) & (y < 150)
    red, coat = (y > 175) & (x < 100), (y > 175) & (x >= 100)
    pixels = np.full((240, 200, 3), 230, np.uint8)
    pixels[cap | strand | coat] = DARK
    pixels[red] = RED
    return SimpleNamespace(
        view=SimpleNamespace(pixels=pixels, head=100.0),
        zones=SimpleNamespace(below_chin=y > 140, hull=hull, silhouette=skull),
        cut=SimpleNamespace(head=hull | cap | strand | red | coat, skin=hull),
        cap=cap,
        strand=strand,
        nothing=np.zeros_like(cap),
    )


def found(scene, mask):
    return doubtful_hair(scene.view, scene.zones, scene.cut, mask)


def test_without_a_mask_hair_is_what_is_left_above_the_chin(scene):
    np.testing.assert_array_equal(found(scene, scene.nothing), (scene.cap | scene.strand) & ~scene.zones.below_chin)


def test_without_a_mask_a_fringe_is_told_from_an_eye_by_its_colour(scene):
    fringe, eye = scene.nothing.copy(), scene.nothing.copy()
    fringe[71:80, 80:120], eye[90:95, 80:90] = True, True
    scene.view.pixels[fringe], scene.view.pixels[eye] = DARK, RED
    scene.cut.skin = scene.cut.skin & ~fringe & ~eye
    hair = found(scene, scene.nothing)
    assert hair[fringe].all() and not hair[eye].any()


def test_without_a_head_there_is_no_hair(scene):
    scene.cut.head = scene.nothing
    assert not found(scene, scene.nothing).any()


def test_a_mask_loses_what_is_skin_and_what_is_ground(scene):
    skin, ground = scene.nothing.copy(), scene.nothing.copy()
    skin[80:100, 90:110] = True
    ground[:20, :40] = True
    np.testing.assert_array_equal(found(scene, scene.cap | skin | ground), scene.cap)


def test_cuts_that_would_take_most_of_the_mask_are_not_followed(scene):
    scene.cut.skin = scene.cut.head
    np.testing.assert_array_equal(found(scene, scene.cap), scene.cap)
    scene.cut.skin, scene.cut.head = scene.nothing, scene.zones.hull
    np.testing.assert_array_equal(found(scene, scene.cap), scene.cap)


def test_a_wall_that_runs_into_the_head_is_no_hair(scene):
    """A tuft that the picture's border cuts stays."""
    wall, tuft = scene.nothing.copy(), scene.nothing.copy()
    wall[:20, :90], tuft[:20, 95:105] = True, True
    scene.cut.head = scene.cut.head | wall | tuft
    hair = found(scene, scene.nothing)
    assert hair[tuft].all() and not hair[wall].any()
