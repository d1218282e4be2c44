"""Irises drawn where we know."""

import cv2
import numpy as np
import pytest

from toongeo.pipeline import find_irises
from toongeo.pipeline.texture.face_picture import EYE_LEFT, EYE_RIGHT, opening_mask

SKIN, WHITE, IRIS = (225, 180, 155), (245, 245, 245), (60, 45, 40)
SHARP = 4  # bits of a pixel's fraction
# Left and right eye: middle, px. Width and height of the openings are chosen by the tests.
MIDDLES = np.array([[290.0, 150.0], [110.0, 150.0]])


def eye_landmarks(width=90.0, height=50.0, scale=1.0, shift=(0.0, 0.0)):
    """68 points of which only the eyes matter."""
    landmarks = np.full((68, 2), np.nan)
    rim = np.array([[-0.5, 0], [-0.22, -0.5], [0.22, -0.5], [0.5, 0], [0.22, 0.5], [-0.22, 0.5]]) * [width, height]
    landmarks[42:48], landmarks[36:42] = MIDDLES[0] + rim, MIDDLES[1] + rim
    return landmarks * scale + shift


def drawn(landmarks, centres, radii, *, colour=IRIS, size=(300, 400)):
    """White openings in skin, with elliptic irises that the lids cut off."""
    img = np.full((*size, 3), SKIN, np.uint8)
    for rims, centre, semi in zip((EYE_LEFT, EYE_RIGHT), centres, radii, strict=True):
        opening = opening_mask(landmarks, rims, size)
        eye = np.full_like(img, WHITE)
        at, axes = (tuple(np.rint(np.asarray(x) * 2**SHARP).astype(int).tolist()) for x in (centre, semi))
        cv2.ellipse(eye, at, axes, 0, 0, 360, colour, -1, cv2.LINE_AA, SHARP)
        img[opening] = eye[opening]
    return img


@pytest.mark.parametrize("radius", [11.0, 15.0, 20.0, 28.0])
@pytest.mark.parametrize("offset", [(0.0, 0.0), (9.0, 1.0), (-6.0, -4.0)])
def test_a_drawn_disc_is_found(radius, offset):
    landmarks, centres = eye_landmarks(), MIDDLES + offset
    for iris, centre in zip(
        find_irises(drawn(landmarks, centres, np.full((2, 2), radius)), landmarks), centres, strict=True
    ):
        # A place is known to a pixel of the view, which is two here; sizes are tried in steps of a sixth.
        assert np.linalg.norm(iris.centre - centre) < 2.0
        np.testing.assert_allclose(iris.radii, radius, rtol=0.15)
        assert 0.7 < iris.contrast <= 1
        with pytest.raises(ValueError, match="read-only"):
            iris.centre[0] = 0


def test_at_the_scale_of_the_view_a_disc_is_found_to_a_pixel():
    scale = 48 / 90
    landmarks = eye_landmarks(scale=scale)
    centres = scale * (MIDDLES + [5.0, 2.0])
    irises = find_irises(drawn(landmarks, centres, np.full((2, 2), 10.0), size=(160, 214)), landmarks)
    for iris, centre in zip(irises, centres, strict=True):
        assert np.abs(iris.centre - centre).max() < 1.0 and np.abs(iris.radii - 10).max() < 1.0


def test_a_tall_iris_is_an_ellipse():
    landmarks = eye_landmarks(70.0, 90.0)
    img = drawn(landmarks, MIDDLES, np.array([[20.0, 34.0], [20.0, 34.0]]))
    for iris, centre in zip(find_irises(img, landmarks), MIDDLES, strict=True):
        np.testing.assert_allclose(iris.centre, centre, atol=3)
        assert 1.4 < iris.radii[1] / iris.radii[0] < 1.9


def test_an_iris_that_fills_the_eye_is_large():
    landmarks = eye_landmarks(90.0, 80.0)
    for iris in find_irises(drawn(landmarks, MIDDLES, np.full((2, 2), 43.0)), landmarks):
        assert (iris.radii > 35).all() and iris.contrast > 0.5


def test_highlights_and_colour_are_no_hindrance():
    landmarks = eye_landmarks()
    img = drawn(landmarks, MIDDLES, np.full((2, 2), 18.0), colour=(70, 120, 220))
    for x, y in MIDDLES.astype(int).tolist():
        cv2.circle(img, (x - 6, y - 6), 6, (255, 255, 255), -1, cv2.LINE_AA)
    for iris, centre in zip(find_irises(img, landmarks), MIDDLES, strict=True):
        assert np.linalg.norm(iris.centre - centre) < 2.5
        np.testing.assert_allclose(iris.radii, 18, rtol=0.15)


def test_eyes_that_squint_are_told_apart():
    landmarks = eye_landmarks()
    centres = MIDDLES + np.array([[-10.0, 0], [10.0, 0]])
    for iris, centre in zip(
        find_irises(drawn(landmarks, centres, np.full((2, 2), 15.0)), landmarks), centres, strict=True
    ):
        assert np.linalg.norm(iris.centre - centre) < 3.0


def test_shut_small_missing_and_empty_eyes_have_none():
    landmarks = eye_landmarks()
    img = drawn(landmarks, MIDDLES, np.full((2, 2), 15.0))
    shut = eye_landmarks(height=10.0)
    assert find_irises(drawn(shut, MIDDLES, np.full((2, 2), 15.0)), shut) == (None, None)
    small = landmarks * 0.05
    assert find_irises(img, small) == (None, None)
    white = drawn(landmarks, MIDDLES, np.full((2, 2), 15.0), colour=WHITE)
    assert find_irises(white, landmarks) == (None, None)
    wink = landmarks.copy()
    wink[36:42] = np.nan
    left, right = find_irises(img, wink)
    assert right is None and np.linalg.norm(left.centre - MIDDLES[0]) < 2
    wink[36:42] = shut[36:42]
    left, right = find_irises(img, wink)
    assert right is None and np.linalg.norm(left.centre - MIDDLES[0]) < 2


def test_where_the_picture_begins_does_not_matter():
    landmarks = eye_landmarks()
    img = drawn(landmarks, MIDDLES + [4.0, 2.0], np.full((2, 2), 15.0))
    moved = cv2.copyMakeBorder(img, 31, 8, 17, 5, cv2.BORDER_REPLICATE)
    for a, b in zip(find_irises(img, landmarks), find_irises(moved, landmarks + [17, 31]), strict=True):
        np.testing.assert_allclose(b.centre, a.centre + [17, 31], atol=1e-3)
        np.testing.assert_allclose(b.radii, a.radii)
        assert b.contrast == pytest.approx(a.contrast, abs=1e-3)


@pytest.mark.parametrize("scale", [0.5, 2.0, 5.0])
def test_how_large_the_picture_is_does_not_matter(scale):
    landmarks, centres = eye_landmarks(), MIDDLES + [4.0, 2.0]
    size = (round(300 * scale), round(400 * scale))
    img = drawn(scale * landmarks, scale * centres, np.full((2, 2), 15.0 * scale), size=size)
    reference = find_irises(drawn(landmarks, centres, np.full((2, 2), 15.0)), landmarks)
    for a, b in zip(reference, find_irises(img, scale * landmarks), strict=True):
        np.testing.assert_allclose(b.centre / scale, a.centre, atol=2.0)  # a pixel of the view
        np.testing.assert_allclose(b.radii / scale, a.radii, rtol=0.2)  # a step of sizes


def test_same_input_same_irises(cartoon):
    first, again = find_irises(*cartoon("manga_girl")), find_irises(*cartoon("manga_girl"))
    for a, b in zip(first, again, strict=True):
        np.testing.assert_array_equal(np.r_[a.centre, a.radii, a.contrast], np.r_[b.centre, b.radii, b.contrast])


def test_bad_input_is_named():
    img, landmarks = np.zeros((50, 50, 3), np.uint8), eye_landmarks()
    with pytest.raises(ValueError, match=r"img: expected \(H, W, 3\) uint8 RGB, got float64"):
        find_irises(img.astype(float), landmarks)
    with pytest.raises(ValueError, match="landmarks: expected 68 points in iBUG order, got 67"):
        find_irises(img, landmarks[:67])
