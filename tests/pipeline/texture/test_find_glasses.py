import cv2
import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo.pipeline.texture.find_glasses import find_glasses
from toongeo.pipeline.texture.without_glasses import without_glasses

WEARERS = ("astronaut", "blue_girl", "moustache_man")


def worn(img, landmarks, *, dark=False):
    """The picture with round glasses and the mask of what they cover."""
    out, ink = img.copy(), np.zeros(img.shape[:2], np.uint8)
    width = np.mean([np.linalg.norm(landmarks[a + 3] - landmarks[a]) for a in (36, 42)])
    thick = max(2, round(0.07 * width))
    middles = [landmarks[a : a + 6].mean(0) + [0, 0.1 * width] for a in (36, 42)]
    for layer, colour in ((out, (35, 30, 28)), (ink, 255)):
        for middle in middles:
            axes = (round(0.85 * width), round(0.68 * width))
            cv2.ellipse(layer, np.rint(middle).astype(int).tolist(), axes, 0, 0, 360, colour, -1 if dark else thick)
        ends = [np.rint(m + [s * 0.85 * width, 0]).astype(int).tolist() for m, s in zip(middles, (1, -1), strict=True)]
        cv2.line(layer, *ends, colour, thick)
    return out, ink > 0


@pytest.mark.parametrize("name", CARTOONS)
def test_faces_without_glasses_wear_none(cartoon, name):
    assert find_glasses(*cartoon(name)) is None


@pytest.mark.parametrize("name", WEARERS)
@pytest.mark.parametrize("dark", [False, True])
def test_glasses_are_found_where_they_are(cartoon, name, dark):
    img, landmarks = cartoon(name)
    picture, ink = worn(img, landmarks, dark=dark)
    found = find_glasses(picture, landmarks)
    assert found is not None and found.kind == ("dark" if dark else "clear")
    assert (found.cover & ink).sum() > 0.6 * ink.sum()  # what lies on brows and lids is spared


def test_a_turned_and_smaller_picture_has_the_same_glasses(cartoon):
    img, landmarks = cartoon("astronaut")
    picture, _ = worn(img, landmarks)
    half = cv2.resize(picture, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    assert find_glasses(half, (landmarks + 0.5) / 2 - 0.5).kind == "clear"
    turned = np.ascontiguousarray(picture[::-1, ::-1])
    assert find_glasses(turned, np.array(picture.shape[1::-1]) - 1 - landmarks).kind == "clear"


def test_unknown_eyes_wear_nothing(cartoon):
    img, landmarks = cartoon("astronaut")
    picture, _ = worn(img, landmarks)
    landmarks = landmarks.copy()
    landmarks[40] = np.nan
    assert find_glasses(picture, landmarks) is None


def test_without_clear_glasses_the_face_is_nearly_what_it_was(cartoon):
    img, landmarks = cartoon("astronaut")
    picture, ink = worn(img, landmarks)
    glasses = find_glasses(picture, landmarks)
    bare = without_glasses(picture, landmarks, glasses)
    untouched = ~glasses.cover
    np.testing.assert_array_equal(bare[untouched], picture[untouched])
    covered = ink & glasses.cover
    before, after = (np.abs(a.astype(int) - img)[covered].mean() for a in (picture, bare))
    assert after < 0.25 * before


def test_behind_dark_glasses_are_eyes(cartoon):
    img, landmarks = cartoon("astronaut")
    picture, _ = worn(img, landmarks, dark=True)
    bare = without_glasses(picture, landmarks, find_glasses(picture, landmarks))
    for first in (36, 42):
        eye = landmarks[first : first + 6]
        at = np.rint(eye.mean(0)).astype(int)
        white = np.rint(eye[0] + 0.15 * (eye[3] - eye[0])).astype(int)
        assert bare[at[1], at[0]].mean() < 60  # a pupil
        assert bare[white[1], white[0]].mean() > 180
        below = np.rint(eye[[4, 5]].mean(0) + [0, 0.25 * np.linalg.norm(eye[3] - eye[0])]).astype(int)
        assert bare[below[1], below[0]].mean() > 110  # skin, where the lens was
