"""An iris drawn where an eye would show it gives back the gaze of that eye."""

import numpy as np
import pytest

from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.model.anatomy.parts import SIDES
from toongeo.pipeline import aim_eyes, fit_eyes
from toongeo.pipeline.texture.eyes.aim_eyes import LEAST_FRONT
from toongeo.pipeline.texture.eyes.find_irises import Iris


@pytest.fixture(scope="module", params=["moustache_man", "blonde_girl_threequarter"])
def face_and_eyes(request, aligned, transferred):
    """From the front and from the side."""
    face = aligned(request.param)
    return face, fit_eyes(face, transferred(request.param))


def pole(eyes, side, weights):
    """The middle of the iris (3,), mm."""
    front = eyes.templates[side].vertices[:, 2].argmax()
    return eyes.looking(side, weights)[front]


def iris_at(px):
    return Iris(np.asarray(px, float), np.array([5.0, 5.0]), 1.0)


@pytest.mark.parametrize(
    "wanted",
    [
        {},
        {"eyeLookOutLeft": 0.7, "eyeLookInRight": 0.4},
        {"eyeLookInLeft": 0.5, "eyeLookUpLeft": 0.9, "eyeLookOutRight": 0.8, "eyeLookDownRight": 0.6},
    ],
)
def test_the_gaze_of_a_seen_iris_comes_back(face_and_eyes, wanted):
    face, eyes = face_and_eyes
    poles = np.array([pole(eyes, side, wanted) for side in (0, 1)])
    towards_viewer = face.camera.view(poles - eyes.centres)[:, 2] / eyes.radii
    irises = tuple(iris_at(px) for px in face.project(poles))
    aimed = aim_eyes(face, eyes, irises, unsure=(0, 0))
    expected = np.array([wanted.get(name, 0.0) for name in GAZE_NAMES])
    for side in (0, 1):
        if towards_viewer[side] > LEAST_FRONT:  # not so far aside that no picture shows it
            np.testing.assert_allclose(aimed.pose.reshape(2, 4)[side], expected.reshape(2, 4)[side], atol=0.02)
            np.testing.assert_allclose(
                aimed.looking_as_drawn(side), eyes.looking(side, wanted), atol=0.02 * eyes.radii[side]
            )
    assert (towards_viewer > LEAST_FRONT).any()
    np.testing.assert_array_equal(aimed.centres, eyes.centres)
    assert not eyes.pose.any()


def test_what_the_pose_of_the_head_leaves_open_is_no_gaze(face_and_eyes):
    """Up to the given angles the eyes look straight; beyond them, so much less aside."""
    face, eyes = face_and_eyes
    for weight in (0.3, 0.9):
        iris = iris_at(face.project(pole(eyes, 0, {"eyeLookDownLeft": weight})[None])[0])
        angle = weight * eyes.turn[0, 1]
        for unsure in (angle / 3, 2 * angle):
            down = aim_eyes(face, eyes, (iris, None), unsure=(90, unsure)).pose
            expected = max(angle - unsure, 0) / eyes.turn[0, 1]
            np.testing.assert_allclose(
                down, np.where(np.array(GAZE_NAMES) == "eyeLookDownLeft", expected, 0), atol=0.02
            )


def test_an_eye_without_an_iris_looks_ahead(face_and_eyes):
    face, eyes = face_and_eyes
    assert not aim_eyes(face, eyes, (None, None)).pose.any()
    px = face.project(pole(eyes, 0, {"eyeLookDownLeft": 0.5})[None])[0]
    assert not aim_eyes(face, eyes, (iris_at(px), None)).pose.reshape(2, 4)[1].any()


def test_an_iris_beside_its_eyeball_gives_the_farthest_gaze_towards_it(face_and_eyes):
    face, eyes = face_and_eyes
    for side, name in enumerate(SIDES):
        irises = [None, None]
        irises[side] = iris_at(face.project(eyes.centres[side][None])[0] - [0, 1e4])
        aimed = aim_eyes(face, eyes, tuple(irises))
        assert aimed.pose[GAZE_NAMES.index(f"eyeLookUp{name.capitalize()}")] == 1.0
        assert ((aimed.pose >= 0) & (aimed.pose <= 1)).all()
