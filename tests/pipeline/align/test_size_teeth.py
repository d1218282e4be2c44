import numpy as np
import pytest

from toongeo.pipeline.align.size_teeth import size_teeth
from toongeo.pipeline.parse.drawn_mouth import DrawnMouth


@pytest.fixture(scope="module")
def face(aligned):
    return aligned("astronaut")


def banded(face, height):
    """A mouth with teeth in the upper part of its opening, of a height in widths of the mouth."""
    corners = face.project(face.vertices[face.landmark_vertices[[48, 54]]])
    width = float(np.linalg.norm(corners[1] - corners[0]))
    shape = (int(corners[:, 1].max() + 2 * width), int(corners[:, 0].max() + width))
    inside, teeth = np.zeros(shape, bool), np.zeros(shape, bool)
    left, right = (corners[:, 0] + [0.1 * width, -0.1 * width]).astype(int)
    top = int(corners[:, 1].min() - 0.05 * width)
    inside[top : top + int(0.6 * width), left:right] = True
    end = top + int(height * width)
    teeth[top:end, left:right] = True
    return DrawnMouth(inside, teeth, np.zeros(shape, bool), width), end


@pytest.mark.parametrize("height", [0.15, 0.2])
def test_the_front_teeth_end_where_the_band_does(face, height):
    mouth, end = banded(face, height)
    upper = face.region("teeth_upper")
    sized = size_teeth(face, mouth)
    px = sized.project(sized.vertices[upper])
    front = np.abs(px[:, 0] - np.median(px[:, 0])) < 0.25 * np.ptp(px[:, 0])
    assert np.percentile(px[front, 1], 97) == pytest.approx(end, abs=0.04 * mouth.width)
    others = ~(upper | face.region("teeth_lower"))
    np.testing.assert_array_equal(sized.vertices[others], face.vertices[others])


def test_a_closed_mouth_changes_nothing(face):
    assert size_teeth(face, None) is face


@pytest.mark.parametrize(("part", "sign"), [("teeth_upper", 1), ("teeth_lower", -1)])
def test_a_row_that_is_not_drawn_goes_back_behind_its_lip(face, part, sign):
    mouth, _ = banded(face, 0.2)
    empty = DrawnMouth(mouth.inside, np.zeros_like(mouth.teeth), mouth.tongue, mouth.width)
    row = face.region(part)
    way = (size_teeth(face, empty).vertices - face.vertices)[row]
    np.testing.assert_allclose(way, np.tile(way[0], (len(way), 1)), atol=1e-9)
    assert sign * way[0, 1] >= 0 and way[0, 0] == way[0, 2] == 0
    hidden = size_teeth(size_teeth(face, empty), empty)
    assert np.abs(hidden.vertices - face.vertices)[row].max() <= 0.76 * np.ptp(face.vertices[row, 1])


def test_lower_teeth_that_are_drawn_stay(face):
    mouth, end = banded(face, 0.2)
    low = mouth.inside.copy()
    low[: end + 5] = False
    sized = size_teeth(face, DrawnMouth(mouth.inside, low, mouth.tongue, mouth.width))
    row = face.region("teeth_lower")
    np.testing.assert_array_equal(sized.vertices[row], face.vertices[row])
