"""Tests of hair masks that were made elsewhere."""

import numpy as np
import pytest

from toongeo import find_hair
from toongeo.io import write_image
from toongeo.pipeline.parse.given_hair import given_hair

SHAPE = (40, 30)


@pytest.fixture
def drawn():
    mask = np.zeros(SHAPE, bool)
    mask[4:20, 3:25] = True
    return mask


def test_bool_levels_and_file_are_the_same_mask(drawn, tmp_path):
    levels = np.where(drawn, 200, 50).astype(np.uint8)
    write_image(tmp_path / "hair.png", levels)
    for mask in (drawn, levels, levels.astype(float), tmp_path / "hair.png", str(tmp_path / "hair.png")):
        found = given_hair(mask, (*SHAPE, 3))
        np.testing.assert_array_equal(found.mask, drawn)
        assert found.trusted and found.reasons == ()


def test_levels_from_128_on_are_hair():
    levels = np.arange(256).reshape(16, 16)
    np.testing.assert_array_equal(given_hair(levels, (16, 16)).mask, levels >= 128)


def test_a_coloured_file_is_hair_where_any_channel_is(tmp_path, drawn):
    img = np.zeros((*SHAPE, 3), np.uint8)
    img[drawn, 1] = 255
    write_image(tmp_path / "hair.png", img)
    np.testing.assert_array_equal(given_hair(tmp_path / "hair.png", SHAPE).mask, drawn)


def test_the_given_array_stays_writable_and_apart(drawn):
    found = given_hair(drawn, SHAPE)
    drawn[:] = True
    assert not found.mask.all()


@pytest.mark.parametrize(
    ("mask", "message"),
    [
        (np.ones((30, 40), bool), r"hair_mask: expected the picture's size \(40, 30\), got shape \(30, 40\)"),
        (np.ones((*SHAPE, 3), bool), r"hair_mask: expected the picture's size"),
        (np.zeros(SHAPE, bool), "hair_mask: expected some hair"),
        (np.full(SHAPE, 255, np.uint8), "hair_mask: .*covers the whole picture"),
        (np.full(SHAPE, 300), r"hair_mask: expected bool or numbers 0..255"),
        (np.full(SHAPE, np.nan), r"hair_mask: expected bool or numbers 0..255"),
        (np.full(SHAPE, "x"), r"hair_mask: expected bool or numbers 0..255"),
    ],
)
def test_what_is_no_mask_is_refused(mask, message):
    with pytest.raises(ValueError, match=message):
        given_hair(mask, SHAPE)


def test_find_hair_takes_the_given_mask(cartoon):
    img, landmarks = cartoon("moustache_man")
    mask = np.zeros(img.shape[:2], bool)
    mask[:50] = True
    found = find_hair(img, landmarks, hair_mask=mask)
    np.testing.assert_array_equal(found.mask, mask)
    with pytest.raises(ValueError, match="hair_mask: expected the picture's size"):
        find_hair(img, landmarks, hair_mask=mask[1:])
