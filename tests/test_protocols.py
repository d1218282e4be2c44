"""Tests of the dataclasses that travel between the stages."""

import numpy as np
import pytest

from toongeo.protocols import FaceLabel, FaceParse


def test_a_mask_holds_the_pixels_of_its_parts():
    labels = np.array([[FaceLabel.SKIN, FaceLabel.HAIR], [FaceLabel.EYE_LEFT, FaceLabel.SKIN]], np.uint8)
    parse = FaceParse(labels, np.ones((2, 2)))
    np.testing.assert_array_equal(parse.mask(FaceLabel.SKIN, FaceLabel.EYE_LEFT), [[True, False], [True, True]])


def test_a_parse_is_a_copy_that_cannot_be_written_to():
    labels = np.zeros((2, 3), np.uint8)
    parse = FaceParse(labels, np.zeros((2, 3)))
    labels[:] = 1
    assert not parse.labels.any()
    with pytest.raises(ValueError, match="read-only"):
        parse.labels[0] = 1


@pytest.mark.parametrize(
    ("labels", "confidence", "message"),
    [
        (np.zeros((2, 3)), np.zeros((2, 3)), r"labels: expected \(H, W\) uint8"),
        (np.full((2, 3), 99, np.uint8), np.zeros((2, 3)), "labels: .*up to 99"),
        (np.zeros((2, 3), np.uint8), np.zeros((3, 2)), r"confidence: expected the shape of labels \(2, 3\)"),
        (np.zeros((2, 3), np.uint8), np.full((2, 3), np.nan), "confidence: expected numbers in"),
        (np.zeros((2, 3), np.uint8), np.full((2, 3), 1.5), "confidence: expected numbers in"),
    ],
)
def test_a_parse_that_is_none_is_refused(labels, confidence, message):
    with pytest.raises(ValueError, match=message):
        FaceParse(labels, confidence)
