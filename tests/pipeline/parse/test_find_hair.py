"""Tests of the hair that is found in pictures."""

import cv2
import numpy as np
import pytest

from toongeo import detect_landmarks, find_hair, fit_3dmm
from toongeo.model.ibug68 import MIRROR

NAMES = ("moustache_man", "blue_girl", "beethoven")


def overlap(one, two):
    return (one & two).sum() / max((one | two).sum(), 1)


@pytest.fixture(scope="module")
def hair(cartoon):
    """Hair of a few bundled drawings, found once."""
    return {name: find_hair(*cartoon(name)) for name in NAMES}


def test_hair_of_drawings_is_that_of_the_hand(hair, shared):
    for name, found in hair.items():
        hand = cv2.imread(str(shared / "data" / "hair_masks" / f"{name}.png"), cv2.IMREAD_GRAYSCALE) > 127
        assert found.trusted and overlap(found.mask, hand) > 0.85, name


def test_soft_edges_belong_to_the_mask(hair):
    for found in hair.values():
        assert overlap(found.alpha > 0.5, found.mask) > 0.93
        assert not found.hat.any()


def test_the_same_picture_gives_the_same_hair(hair, cartoon):
    again = find_hair(*cartoon("blue_girl"))
    np.testing.assert_array_equal(again.mask, hair["blue_girl"].mask)
    np.testing.assert_array_equal(again.alpha, hair["blue_girl"].alpha)


def test_a_mirrored_picture_gives_the_mirrored_hair(hair, cartoon):
    img, landmarks = cartoon("beethoven")
    mirrored = landmarks[MIRROR] * [-1, 1] + [img.shape[1] - 1, 0]
    found = find_hair(np.ascontiguousarray(img[:, ::-1]), mirrored)
    assert found.trusted and overlap(found.mask[:, ::-1], hair["beethoven"].mask) > 0.95


def test_hair_grows_with_the_picture(hair, cartoon):
    img, landmarks = cartoon("blue_girl")
    large = cv2.resize(img, None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC)
    found = find_hair(large, (landmarks + 0.5) * 2 - 0.5)
    half = cv2.resize(found.mask.astype(np.uint8), img.shape[1::-1], interpolation=cv2.INTER_AREA) > 0
    assert overlap(half, hair["blue_girl"].mask) > 0.93


def test_a_bald_head_is_refused(shared):
    folder = shared / "data" / "caricatures"
    found = find_hair(
        cv2.cvtColor(cv2.imread(str(folder / "44.jpg")), cv2.COLOR_BGR2RGB), np.loadtxt(folder / "44.txt")
    )
    assert not found.trusted and found.reasons
    assert not found.mask.any() and not found.hat.any() and not found.alpha.any()  # nothing looks like hair


def test_points_of_a_detector_serve_as_well(hair, cartoon):
    img, _ = cartoon("blue_girl")
    found = find_hair(img, detect_landmarks(img).points)
    assert found.trusted and overlap(found.mask, hair["blue_girl"].mask) > 0.95


def test_one_colour_shows_no_hair(cartoon):
    img, landmarks = cartoon("moustache_man")
    found = find_hair(np.full_like(img, 128), landmarks, fit_3dmm(None, landmarks))
    assert not found.trusted and found.reasons


def test_missing_landmarks_are_completed(hair, cartoon):
    img, landmarks = cartoon("moustache_man")
    landmarks[[0, 1, 16, 60]] = np.nan
    assert overlap(find_hair(img, landmarks).mask, hair["moustache_man"].mask) > 0.9


def test_a_picture_cut_at_the_brows_is_refused_and_no_error(cartoon):
    img, landmarks = cartoon("moustache_man")
    top = int(landmarks[17:27, 1].min())
    found = find_hair(np.ascontiguousarray(img[top:]), landmarks - [0, top])
    assert not found.trusted


@pytest.mark.parametrize("shape", [(40, 30), (40, 30, 4)])
def test_what_is_no_picture_is_refused(shape, cartoon):
    with pytest.raises(ValueError, match="img: expected"):
        find_hair(np.zeros(shape, np.uint8), cartoon("blue_girl")[1])
