"""Tests of the dataclasses that travel between the stages."""

import numpy as np
import pytest

from toongeo.protocols import FaceLabel, FaceParse, HairMask


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


HAIR = np.array([[True, False], [True, False]])


def test_a_hair_mask_is_a_copy_that_cannot_be_written_to():
    mask = HAIR.copy()
    hair = HairMask(mask, trusted=True, alpha=mask.astype(float), hat=~mask)
    mask[:] = True
    np.testing.assert_array_equal(hair.mask, HAIR)
    for array in (hair.mask, hair.alpha, hair.hat):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"mask": HAIR.astype(int), "trusted": True}, r"mask: expected \(H, W\) bool"),
        ({"mask": HAIR, "trusted": False}, "reasons: expected some exactly if not trusted"),
        ({"mask": HAIR, "trusted": True, "reasons": ("bald",)}, "reasons: expected some exactly if not trusted"),
        ({"mask": HAIR, "trusted": True, "alpha": np.ones((3, 2))}, r"alpha: expected numbers in \[0, 1\]"),
        ({"mask": HAIR, "trusted": True, "alpha": HAIR * 2.0}, r"alpha: expected numbers in \[0, 1\]"),
        ({"mask": HAIR, "trusted": True, "hat": HAIR}, "hat: expected bool"),
    ],
)
def test_a_hair_mask_that_is_none_is_refused(fields, message):
    with pytest.raises(ValueError, match=message):
        HairMask(**fields)


def test_hair_of_another_size_than_its_labels_is_refused():
    with pytest.raises(ValueError, match="hair: expected the shape of labels"):
        FaceParse(np.zeros((2, 3), np.uint8), np.zeros((2, 3)), HairMask(HAIR, trusted=True))
