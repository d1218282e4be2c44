"""Where the library takes None for landmarks and finds them."""

import numpy as np
import pytest

from toongeo import detect_landmarks, edit_expression, fit_3dmm, make_avatar
from toongeo.avatar.report import detection_warnings
from toongeo.pipeline import NoFaceError
from toongeo.protocols import LandmarkDetection

WALL = np.full((90, 120, 3), 140, np.uint8)


def test_a_fit_finds_its_landmarks(render):
    img = render(0).picture
    found, given = fit_3dmm(img), fit_3dmm(img, detect_landmarks(img).points)
    assert found.identity.tobytes() == given.identity.tobytes()


@pytest.mark.parametrize("work", [fit_3dmm, make_avatar, lambda img: edit_expression(img, None, {"jawOpen": 1.0})])
def test_without_a_face_there_is_an_error(work):
    with pytest.raises(NoFaceError, match="no face was found"):
        work(WALL)


def test_a_fit_needs_points_or_a_picture():
    with pytest.raises(ValueError, match="landmarks: expected points where there is no picture"):
        fit_3dmm(None)
    with pytest.raises(ValueError, match="scheme: expected 'ibug68' for landmarks that are to be found"):
        fit_3dmm(WALL, scheme="ibug51")


def test_only_doubtful_points_are_warned_of():
    points = np.zeros((68, 2))
    assert detection_warnings(LandmarkDetection(points, np.full(68, 0.9), 0.9)) == ()
    (warning,) = detection_warnings(LandmarkDetection(points, np.full(68, 0.3), 0.9))
    assert "face 90 %, points 30 %" in warning
