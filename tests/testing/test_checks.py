"""The checks pass what ships, and notice what is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from toongeo import testing
from toongeo.caricature import PartMapper
from toongeo.driving import ArkitDriver
from toongeo.pipeline import build_hair
from toongeo.protocols import Coefficients, FaceLabel, FaceParse, HairMask, LandmarkDetection
from toongeo.render import PerspectiveCamera, ScaledOrthographicCamera
from toongeo.testing.example import example


def refused(match):
    return pytest.raises(AssertionError, match=match)


def changing(values):
    """A function that gives another one of these each time."""
    rest = iter(values)
    return lambda *given: next(rest)


def test_regressors():
    testing.check_regressor(lambda img, landmarks: Coefficients(expression=np.zeros(64)), picture=False)
    with refused("expected Coefficients, got dict"):
        testing.check_regressor(lambda img, landmarks: {})
    with refused(r"identity: expected shape \(80,\)"):
        testing.check_regressor(lambda img, landmarks: Coefficients(identity=np.zeros(3)))
    with refused("identity: expected the same a second time"):
        testing.check_regressor(changing(Coefficients(identity=np.full(80, k)) for k in range(9)))

    def writes(img, landmarks):
        landmarks[0] = 0
        return Coefficients()

    with refused("landmarks: expected not to be written to"):
        testing.check_regressor(writes)


def test_detectors():
    points = np.array(example()[1])
    good = LandmarkDetection(points, np.ones(68), 1.0)
    small = LandmarkDetection(0.5 * points, np.ones(68), 1.0)

    def detector(*faces):
        return lambda img: list(faces) if np.ptp(img) else []

    testing.check_landmark_detector(detector(good, small))
    with refused("expected the largest face first"):
        testing.check_landmark_detector(detector(small, good))
    with refused("expected a face in the picture"):
        testing.check_landmark_detector(detector())
    with refused("no face in a grey picture"):
        testing.check_landmark_detector(lambda img: [good])
    with refused("expected LandmarkDetection"):
        testing.check_landmark_detector(detector(points))
    with refused("expected y down"):
        testing.check_landmark_detector(detector(replace(good, points=[0, 400] + points * [1, -1])))
    with refused("36 is the subject's right eye"):
        testing.check_landmark_detector(detector(replace(good, points=[400, 0] + points * [-1, 1])))
    with refused("far outside"):
        testing.check_landmark_detector(detector(replace(good, points=points + 5000)))


def test_parsers_and_hair():
    def parser(img, landmarks, fit=None):
        labels = np.full(img.shape[:2], FaceLabel.SKIN, np.uint8)
        return FaceParse(labels, np.ones(img.shape[:2]))

    testing.check_face_parser(parser)
    with refused("expected FaceParse"):
        testing.check_face_parser(lambda img, landmarks, fit: None)
    with refused("labels: expected"):
        testing.check_face_parser(lambda img, landmarks, fit: parser(img[:9], landmarks))
    with refused("expected some skin"):
        testing.check_face_parser(lambda i, p, f: FaceParse(np.zeros(i.shape[:2], np.uint8), np.ones(i.shape[:2])))
    testing.check_hair_finder(lambda img, landmarks, fit: HairMask(img[..., 0] > 9, True))
    with refused("expected HairMask"):
        testing.check_hair_finder(lambda img, landmarks, fit: img[..., 0] > 9)
    with refused("mask: expected"):
        testing.check_hair_finder(lambda img, landmarks, fit: HairMask(np.ones((3, 3), bool), True))


def test_mappers_generators_and_drivers():
    testing.check_landmark_mapper(PartMapper())

    class Forgetful(PartMapper):
        def to_caricature(self, normal, context):
            return np.asarray(normal) + 5.0

    with refused("expected the drawing back"):
        testing.check_landmark_mapper(Forgetful())
    testing.check_texture_generator(lambda t, s, e, g: (t, np.ones(t.shape[:2])))
    with refused(r"attention: expected \[0, 1\]"):
        testing.check_texture_generator(lambda t, s, e, g: (t, np.full(t.shape[:2], 2.0)))
    with refused("generator: expected"):
        testing.check_texture_generator(lambda t, s, e, g: (t[:3], np.ones(t.shape[:2])))
    testing.check_expression_driver(ArkitDriver(), np.full((3, 52), 0.25))

    class Strange:
        names = ("jawOpen", "beard")

        def frames(self, recording, fps):
            return np.full((2, 2), 2.0)

    with refused("got beard"):
        testing.check_expression_driver(Strange(), None)
    Strange.names = ("jawOpen", "jawLeft")
    with refused(r"frames: expected \[0, 1\]"):
        testing.check_expression_driver(Strange(), None)


def test_cameras():
    testing.check_camera(ScaledOrthographicCamera.look(yaw=30.0, pitch=-10.0))

    class Slanted(ScaledOrthographicCamera):
        def jacobian(self, points):
            return 1.1 * super().jacobian(points)

    look = ScaledOrthographicCamera.look(yaw=10.0)
    with refused("jacobian: expected the derivative"):
        testing.check_camera(Slanted(look.scale, look.rotation, look.translation))
    face = ScaledOrthographicCamera.look(yaw=10.0)
    perspective = PerspectiveCamera(900.0, face.rotation, np.array([0.0, 0.0, -600.0]), np.array([200.0, 150.0]))
    testing.check_camera(perspective)


@pytest.mark.slow
def test_hair_modelers():
    testing.check_hair_modeler(build_hair)
    with refused("expected Hair or None"):
        testing.check_hair_modeler(lambda *given: 3)
