import numpy as np
import pytest

from toongeo.pipeline.parse.drawn_mouth import drawn_mouth
from toongeo.protocols import FaceLabel, FaceParse

WHITE, TONGUE, DARK, GUM = (245, 240, 230), (200, 60, 70), (50, 15, 15), (210, 110, 110)
OPENING = np.s_[40:100, 30:150]


def mouth(img):
    labels = np.zeros(img.shape[:2], np.uint8)
    labels[OPENING] = FaceLabel.INNER_MOUTH
    return drawn_mouth(img, FaceParse(labels, np.ones(labels.shape)))


def picture(**bands):
    img = np.full((140, 180, 3), DARK, np.uint8)
    for colour, rows in bands.items():
        img[rows, 30:150] = {"white": WHITE, "tongue": TONGUE, "gum": GUM}[colour]
    return img


def test_teeth_are_the_light_class_and_a_tongue_is_red():
    found = mouth(picture(white=slice(40, 60), tongue=slice(80, 100)))
    assert found.teeth[45:58, 40:140].all() and not found.teeth[64:].any()
    assert found.tongue[82:97, 40:140].all() and not found.tongue[:78].any()
    assert found.width == 120


def test_lines_between_teeth_belong_to_them():
    img = picture(white=slice(40, 70))
    img[40:70, 60:150:20] = DARK
    assert mouth(img).teeth[45:65, 40:140].all()


def test_a_mouth_full_of_teeth_is_all_teeth_and_an_empty_one_has_none():
    assert mouth(picture(white=slice(40, 100))).teeth[OPENING][3:-3, 3:-3].all()
    assert not mouth(picture()).teeth.any()
    assert not mouth(picture(gum=slice(40, 100))).teeth.any()


def test_the_rim_of_the_opening_is_left_out():
    found = mouth(picture(white=slice(40, 100)))
    assert not found.inside[40].any() and not found.inside[:, 30].any() and found.inside[42, 32]


@pytest.mark.parametrize("side", [0, 5])
def test_a_closed_mouth_shows_nothing(side):
    img, labels = np.zeros((50, 50, 3), np.uint8), np.zeros((50, 50), np.uint8)
    labels[10 : 10 + side, 10 : 10 + side] = FaceLabel.INNER_MOUTH
    assert drawn_mouth(img, FaceParse(labels, np.ones(labels.shape))) is None
