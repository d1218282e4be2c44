import sys

import numpy as np
import pytest
import skimage.data

from tests.conftest import CARTOONS
from toongeo import detect_faces, detect_landmarks
from toongeo.metrics import landmark_error
from toongeo.model.ibug68 import MIRROR, PARTS
from toongeo.pipeline import NoFaceError
from toongeo.protocols import LandmarkDetection


def inner_error(found, truth):
    return landmark_error(found, truth)["inner51"]


@pytest.fixture(scope="module")
def photograph(render):
    return render(0)


@pytest.fixture(scope="module")
def found(photograph):
    return detect_landmarks(photograph.picture)


@pytest.fixture(scope="module")
def crowd(render):
    """Landmarks and what was found, of nine renders of all kinds."""
    found = []
    for k in range(1, 10):
        truth = render(k, ("person", "caricature", "cartoon")[k % 3], ("photo", "painted", "flat")[k % 3])
        found.append((truth.landmarks, detect_faces(truth.picture)))
    return found


def test_most_renders_are_found_with_their_points(crowd):
    errors = [min((inner_error(face.points, truth) for face in faces), default=np.inf) for truth, faces in crowd]
    assert np.median(errors) < 0.06
    assert np.sum(np.array(errors) < 0.12) >= 7


@pytest.mark.parametrize("example", CARTOONS)
def test_the_face_of_each_example_is_the_largest_that_is_found(cartoon, example):
    """The astronaut's picture has a helmet in it that looks somewhat like a larger face."""
    img, landmarks = cartoon(example)
    assert inner_error(detect_landmarks(img).points, landmarks) < 0.1


def test_the_same_picture_gives_the_same_bytes(photograph, found):
    again = detect_landmarks(photograph.picture)
    assert again.points.tobytes() == found.points.tobytes()
    assert again.confidence.tobytes() == found.confidence.tobytes()


def test_points_follow_a_picture_that_is_mirrored_moved_or_enlarged(photograph, found):
    picture, width = photograph.picture, photograph.picture.shape[1]
    mirrored = detect_landmarks(np.ascontiguousarray(picture[:, ::-1])).points[MIRROR] * [-1, 1] + [width - 1, 0]
    moved = detect_landmarks(np.pad(picture, ((40, 0), (64, 0), (0, 0)), "edge")).points - [64, 40]
    larger = (detect_landmarks(np.repeat(np.repeat(picture, 3, 0), 3, 1)).points + 0.5) / 3 - 0.5
    for points in (mirrored, moved, larger):
        assert inner_error(points, found.points) < 0.03


def test_a_tilted_face_is_found(photograph, found):
    import cv2

    turn = cv2.getRotationMatrix2D((159.5, 159.5), 40, 1)
    tilted = cv2.warpAffine(photograph.picture, turn, (320, 320), borderMode=cv2.BORDER_REPLICATE)
    assert inner_error(detect_landmarks(tilted).points, found.points @ turn[:, :2].T + turn[:, 2]) < 0.05


def test_faces_come_by_size(render):
    large, small = render(0), render(0, size=200)
    picture = np.full((320, 560, 3), 90, np.uint8)
    picture[:, 240:] = large.picture
    picture[60:260, 20:220] = small.picture
    faces = detect_faces(picture)
    assert len(faces) == 2
    assert inner_error(faces[0].points, large.landmarks + [240, 0]) < 0.06
    assert inner_error(detect_landmarks(picture, face=1).points, small.landmarks + [20, 60]) < 0.08
    with pytest.raises(NoFaceError, match="only 2 faces were found"):
        detect_landmarks(picture, face=2)


@pytest.mark.parametrize("value", [0, 128, 255])
def test_a_blank_picture_has_no_face(value):
    assert detect_faces(np.full((90, 120, 3), value, np.uint8)) == []


@pytest.mark.parametrize("name", ["chelsea", "page"])
def test_animals_and_text_have_no_face(name):
    picture = getattr(skimage.data, name)()
    assert detect_faces(picture if picture.ndim == 3 else np.stack([picture] * 3, axis=2)) == []


@pytest.mark.parametrize("shape", [(1, 1), (3, 200), (9, 9), (40, 4000)])
def test_pictures_too_small_for_a_face_have_none(shape, rng):
    assert detect_faces(rng.integers(0, 255, (*shape, 3), dtype=np.uint8)) == []


def test_no_face_is_an_error_that_says_what_to_do():
    with pytest.raises(NoFaceError, match=r"no face was found in the picture of 30 x 20 px; give .*--landmarks"):
        detect_landmarks(np.zeros((20, 30, 3), np.uint8))


def test_bad_input_is_refused():
    with pytest.raises(ValueError, match=r"img: expected \(H, W, 3\) uint8"):
        detect_faces(np.zeros((20, 30, 3)))
    with pytest.raises(ValueError, match="face: expected 0 for the largest"):
        detect_landmarks(np.zeros((20, 30, 3), np.uint8), face=-1)


def test_another_detector_can_take_its_place():
    points = np.random.default_rng(0).uniform(0, 50, (68, 2))

    def detector(img):
        return [LandmarkDetection(points, np.full(68, 0.9), 0.8)]

    found = detect_landmarks(np.zeros((60, 60, 3), np.uint8), detector=detector)
    np.testing.assert_array_equal(found.points, points)
    np.testing.assert_array_equal(found.box, [*points.min(0), *points.max(0)])
    assert found.is_sure


@pytest.mark.parametrize("part", ["eye_right", "eye_left", "mouth"])
def test_a_face_is_sure_by_its_eyes_and_its_mouth(part):
    """Each of them alone can spoil it; the jaw cannot, nor can brows and nose unless they are worse."""
    points, confidence = np.random.default_rng(0).uniform(0, 50, (68, 2)), np.full(68, 0.95)
    confidence[:17], confidence[17:36] = 0.0, 0.5
    assert LandmarkDetection(points, confidence, 0.5).is_sure
    assert not LandmarkDetection(points, confidence, 0.49).is_sure
    confidence[17:36] = 0.4
    assert not LandmarkDetection(points, confidence, 0.5).is_sure
    confidence[17:] = 1.0
    confidence[PARTS[part]] = 0.25 if part != "mouth" else 0.6
    assert confidence[17:].mean() > 0.8 and not LandmarkDetection(points, confidence, 1.0).is_sure


@pytest.mark.parametrize(
    ("points", "confidence", "score", "message"),
    [
        (np.zeros((51, 2)), np.ones(68), 1, r"points: expected \(68, 2\)"),
        (np.full((68, 2), np.nan), np.ones(68), 1, "points: expected"),
        (np.zeros((68, 2)), np.full(68, 2), 1, "confidence: expected"),
        (np.zeros((68, 2)), np.ones(68), 1.5, "score: expected"),
    ],
)
def test_a_detection_is_checked(points, confidence, score, message):
    with pytest.raises(ValueError, match=message):
        LandmarkDetection(points, confidence, score)


def test_confidence_means_what_it_says(crowd):
    """On renders: of points with a chance p, about the share p lies within 8 % of the outer-eye distance."""
    chances, right = [], []
    for truth, faces in crowd:
        for face in faces:
            if inner_error(face.points, truth) < 0.3:
                eyes = np.linalg.norm(truth[36] - truth[45])
                chances.append(face.confidence)
                right.append(np.linalg.norm(face.points - truth, axis=1) < 0.08 * eyes)
    chances, right = np.concatenate(chances), np.concatenate(right)
    assert abs(chances.mean() - right.mean()) < 0.1
    low, high = chances < np.median(chances), chances >= np.median(chances)
    assert right[high].mean() > right[low].mean() + 0.05


def test_eyes_behind_dark_glasses_are_not_sure(photograph, found, monkeypatch):
    """Whatever the cascade says of them, it is half as sure; of the other points it is as sure as it was."""
    import cv2

    worn, unit = photograph.picture.copy(), np.linalg.norm(found.points[36] - found.points[45])
    eyes = np.r_[PARTS["eye_right"], PARTS["eye_left"]]
    for part in (eyes[:6], eyes[6:]):
        x, y = map(float, photograph.landmarks[part].mean(0))
        cv2.ellipse(worn, ((x, y), (0.47 * unit, 0.42 * unit), 0.0), (22, 20, 20), -1)
    behind = detect_landmarks(worn)
    assert found.is_sure and not behind.is_sure
    module = sys.modules["toongeo.pipeline.landmarks.detect_faces"]  # the package names the function alike
    monkeypatch.setattr(module, "are_dark", lambda light: False)
    without = detect_landmarks(worn)
    np.testing.assert_array_equal(behind.points, without.points)
    np.testing.assert_array_equal(behind.confidence[eyes], without.confidence[eyes] / 2)
    others = np.delete(np.arange(68), eyes)
    np.testing.assert_array_equal(behind.confidence[others], without.confidence[others])
