import dataclasses

import numpy as np
import pytest

from toongeo.pipeline import fit_cranium
from toongeo.protocols import FaceLabel, FaceParse


@pytest.fixture(scope="module")
def face(aligned):
    return aligned("moustache_man")


def parsed(face, share):
    """A parse whose head ends at a share of the skull's height above the brows, in a picture with room above."""
    px = face.project(face.vertices)
    brows, top = px[face.landmark_vertices[17:27], 1].min(), px[face.region("skin"), 1].min()
    line = brows + share * (top - brows)
    labels = np.full((round(px[:, 1].max()) + 20, round(px[:, 0].max()) + 40), FaceLabel.SKIN, np.uint8)
    labels[: round(line)] = FaceLabel.BACKGROUND
    return FaceParse(labels, np.ones(labels.shape, np.float32)), line


@pytest.fixture(scope="module")
def roomy(face):
    """The same face, 200 px further down in its picture."""
    camera = face.camera
    return dataclasses.replace(face, camera=camera.cropped([0, -200], 1.0))


def test_a_skull_that_is_drawn_taller_stays(roomy):
    parse, _ = parsed(roomy, 1.3)
    assert fit_cranium(roomy, parse) is roomy


def test_a_skull_comes_down_to_the_top_of_the_head(roomy):
    parse, line = parsed(roomy, 0.8)
    low = fit_cranium(roomy, parse)
    assert abs(roomy.project(low.vertices[low.region("skin")])[:, 1].min() - line) < 2


def test_only_what_is_above_the_brows_moves_and_only_down(roomy):
    low = fit_cranium(roomy, parsed(roomy, 0.8)[0])
    moved = low.vertices - roomy.vertices
    below = roomy.vertices[:, 1] <= roomy.vertices[roomy.landmark_vertices[17:27], 1].max()
    np.testing.assert_array_equal(moved[below], 0)
    np.testing.assert_array_equal(moved[:, [0, 2]], 0)
    assert (moved[:, 1] <= 0).all()
    above = np.flatnonzero(~below)
    order = above[np.argsort(roomy.vertices[above, 1])]
    assert (np.diff(low.vertices[order, 1]) >= 0).all()  # nothing passes anything else
    levels = roomy.vertices[order, 1]
    np.testing.assert_allclose(np.interp(levels, levels, moved[order, 1]), moved[order, 1], atol=1e-9)  # height alone


def test_a_skull_keeps_a_height_that_suits_the_face(roomy):
    """A parse that ends at the brows is no reason to cut the head off."""
    low = fit_cranium(roomy, parsed(roomy, 0.05)[0])
    skin = low.region("skin")
    brows = low.vertices[low.landmark_vertices[17:27], 1].max()
    left = (low.vertices[skin, 1].max() - brows) / (roomy.vertices[skin, 1].max() - brows)
    assert 0.4 < left < 0.9


def test_a_head_that_the_picture_cuts_off_stays(face, roomy):
    parse, line = parsed(roomy, 0.6)
    cut = FaceParse(parse.labels[round(line) :], parse.confidence[round(line) :])
    shifted = dataclasses.replace(roomy, camera=roomy.camera.cropped([0, round(line)], 1.0))
    assert fit_cranium(shifted, cut) is shifted


def test_a_parse_without_a_head_is_refused(face):
    nothing = FaceParse(np.zeros((50, 50), np.uint8), np.ones((50, 50), np.float32))
    with pytest.raises(ValueError, match="parse: expected pixels that are not background, got none"):
        fit_cranium(face, nothing)
