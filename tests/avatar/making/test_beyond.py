"""What is beyond the library is said, and not said where it is not."""

import dataclasses

import cv2
import numpy as np
import pytest

from tests.conftest import CARTOONS, PORTRAITS
from toongeo import align_face, build_rig, fit_3dmm, read_image, read_landmarks
from toongeo.app.cli import main
from toongeo.avatar.making.beyond import beyond_warnings
from toongeo.io import write_image
from toongeo.pipeline import landmark_evidence
from toongeo.render import ScaledOrthographicCamera

NAME = "manga_girl"


@pytest.fixture(scope="module")
def drawn(cartoon, aligned, transferred):
    """Picture, landmarks, face and rig of an example."""
    return *cartoon(NAME), aligned(NAME), transferred(NAME)


def said(img, landmarks, face, rig):
    return " | ".join(beyond_warnings(landmark_evidence(img, landmarks), landmarks, face, rig))


def test_nothing_is_said_of_the_examples(cartoon, aligned, drawn):
    for name in CARTOONS:  # the rig is one example's: what mouths do is told below
        assert said(*cartoon(name), aligned(name), drawn[3]) == "", name


def test_nothing_is_said_of_the_portraits(shared, drawn):
    for path in sorted((shared / "data" / "portraits").glob("*.pts")):
        img = read_image(next(p for p in path.parent.glob(f"{path.stem}.*") if p.suffix != ".pts"))
        landmarks = read_landmarks(path)
        face = dataclasses.replace(drawn[2], camera=fit_3dmm(img, landmarks).camera)
        assert said(img, landmarks, face, drawn[3]) == "", path.stem


def test_every_mouth_of_the_examples_opens(avatars):
    for name in ("moustache_man", "blue_girl", "astronaut"):
        assert not [warning for warning in avatars(name).report.warnings if "mouth" in warning], name


def test_a_mouth_drawn_as_a_dot_does_not_open(drawn):
    img, landmarks, *_ = drawn
    dot = landmarks.copy()
    dot[48:] = dot[48:].mean(0) + 0.12 * (dot[48:] - dot[48:].mean(0))
    face = align_face(fit_3dmm(None, dot), dot, noise=0)
    assert "the mouth hardly opens" in said(img, dot, face, build_rig(face))


def test_a_blank_picture(drawn):
    img, *rest = drawn
    assert said(np.full_like(img, 200), *rest) == "the picture shows nothing where the landmarks are"


def test_landmarks_of_another_picture(cartoon, drawn):
    img, (_, other) = drawn[0], cartoon("moustache_man")
    assert "are they another's?" in said(img, other, *drawn[2:])


@pytest.mark.parametrize(("yaw", "profile"), [(-75, True), (-45, False), (55, False), (63, True)])
def test_profiles(model, drawn, yaw, profile):
    """Of heads of the model, as they are fitted to what a camera sees of them."""
    from toongeo.model.anatomy.visible_contour import visible_contour

    camera = ScaledOrthographicCamera.look(yaw=yaw, size=400)
    seen = camera.project(model.mean[visible_contour(model, camera, model.mean, model.landmarks)])
    face = dataclasses.replace(drawn[2], camera=fit_3dmm(None, seen).camera)
    assert ("a profile" in said(*drawn[:2], face, drawn[3])) is profile


def shut(landmarks, *eyes):
    """Landmarks with both lids of some eyes on the line between the corners."""
    points = landmarks.copy()
    for first in eyes:
        for upper, lower, share in ((1, 5, 1 / 3), (2, 4, 2 / 3)):
            a, b = landmarks[first], landmarks[first + 3]
            points[[first + upper, first + lower]] = a + share * (b - a)
    return points


def test_closed_eyes_and_winks(drawn):
    img, landmarks, *rest = drawn
    assert "both eyes are closed" in said(img, shut(landmarks, 36, 42), *rest)
    assert "the right eye is closed in the picture, a wink" in said(img, shut(landmarks, 36), *rest)
    assert "the left eye is closed in the picture, a wink" in said(img, shut(landmarks, 42), *rest)
    hidden = landmarks.copy()
    hidden[42:48] = np.nan
    assert "closed" not in said(img, hidden, *rest)


def with_glasses(img, landmarks):
    out = img.copy()
    for first in (36, 42):
        eye = landmarks[first : first + 6]
        width = np.linalg.norm(eye[0] - eye[3])
        height = max(0.9 * width, 1.5 * np.ptp(eye[:, 1]))
        box = (tuple(map(float, eye.mean(0))), (float(1.7 * width), float(height)), 0.0)
        cv2.ellipse(out, box, (22, 20, 20), -1)
    return out


def test_dark_glasses(cartoon, drawn):
    for img, landmarks in (cartoon("moustache_man"), cartoon("blue_girl"), cartoon("astronaut")):
        worn = landmark_evidence(with_glasses(img, landmarks), landmarks)
        assert worn.has_dark_glasses
    img, landmarks = cartoon("moustache_man")
    assert "dark glasses" in said(with_glasses(img, landmarks), landmarks, *drawn[2:])


def test_the_command_says_it(tmp_path, capsys):
    points, out = PORTRAITS / "blue_girl.pts", tmp_path / "blank.ply"
    size = read_image(PORTRAITS / "blue_girl.png").shape
    write_image(tmp_path / "blank.png", np.full(size, 220, np.uint8))
    arguments = ["make", str(tmp_path / "blank.png"), "--landmarks", str(points), "-o", str(out)]
    assert main([*arguments, "--texture-size", "64", "--no-hair"]) == 0
    assert "warning: the picture shows nothing where the landmarks are" in capsys.readouterr().out
