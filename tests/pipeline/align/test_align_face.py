import numpy as np
import pytest

from toongeo.io import read_image, read_landmarks
from toongeo.pipeline import align_face, fit_3dmm


def outer_eyes(landmarks):
    return np.linalg.norm(landmarks[36] - landmarks[45])


@pytest.fixture(scope="module")
def girl(cartoon):
    img, landmarks = cartoon("blue_girl")
    return fit_3dmm(img, landmarks), landmarks


def test_reaches_every_landmark_of_the_cartoons(cartoon):
    from tests.conftest import CARTOONS

    for name in CARTOONS:
        img, landmarks = cartoon(name)
        face = align_face(fit_3dmm(img, landmarks), landmarks)
        error = np.linalg.norm(face.project(face.vertices[face.landmark_vertices]) - landmarks, axis=1)
        assert np.sqrt((error[17:] ** 2).mean()) <= 1e-3 * outer_eyes(landmarks), name


def test_reaches_every_landmark_of_the_portraits(shared):
    for path in sorted((shared / "data" / "portraits").glob("*.pts")):
        landmarks = read_landmarks(path)
        picture = next(p for p in path.parent.glob(f"{path.stem}.*") if p.suffix != ".pts")
        face = align_face(fit_3dmm(read_image(picture), landmarks), landmarks)
        error = np.linalg.norm(face.project(face.vertices[face.landmark_vertices]) - landmarks, axis=1)
        assert np.sqrt((error[17:] ** 2).mean()) <= 1e-3 * outer_eyes(landmarks), path.stem


def test_landmarks_that_are_met_already_move_nothing(girl):
    fit, _ = girl
    met = fit.project(fit.vertices[fit.landmark_vertices])
    np.testing.assert_allclose(align_face(fit, met).vertices, fit.vertices, atol=1e-6)


def test_anchors_keep_their_depth(girl):
    fit, landmarks = girl
    face = align_face(fit, landmarks)
    before, after = (fit.camera.depth(V[fit.landmark_vertices]) for V in (fit.vertices, face.vertices))
    np.testing.assert_allclose(after, before, atol=0.05)


def test_a_missing_landmark_anchors_nothing(girl):
    fit, landmarks = girl
    fewer = landmarks.copy()
    fewer[30] = np.nan
    moved = landmarks.copy()
    moved[30] += 40
    face = align_face(fit, fewer)
    nose = fit.landmark_vertices[30]
    assert np.isfinite(face.vertices).all()
    wanted = np.linalg.norm(fit.project(face.vertices[[nose]]) - landmarks[30])
    assert wanted < 0.5 * np.linalg.norm(moved[30] - landmarks[30])
    others = np.arange(68) != 30
    error = face.project(face.vertices[fit.landmark_vertices])[others] - landmarks[others]
    assert np.abs(error[17:]).max() < 1e-3 * outer_eyes(landmarks)


def test_teeth_and_tongue_move_as_a_whole(girl):
    """One affine map carries all of them, and stretches no axis more than twice as much as another."""
    fit, landmarks = girl
    face = align_face(fit, landmarks)
    parts = np.any([fit.region(name) for name in ("teeth_upper", "teeth_lower", "tongue")], axis=0)
    before = np.column_stack([fit.vertices[parts], np.ones(parts.sum())])
    affine, *_ = np.linalg.lstsq(before, face.vertices[parts], rcond=None)
    np.testing.assert_allclose(before @ affine, face.vertices[parts], atol=1e-9)
    stretches = np.linalg.svd(affine[:3], compute_uv=False)
    assert stretches[0] < 2 * stretches[2]


def test_bad_landmarks_are_refused(girl):
    fit, _ = girl
    with pytest.raises(ValueError, match="landmarks: expected 68 points in iBUG order, got 51"):
        align_face(fit, np.zeros((51, 2)))
    with pytest.raises(ValueError, match="landmarks: expected at least one point"):
        align_face(fit, np.full((68, 2), np.nan))
    with pytest.raises(ValueError, match="landmarks: expected finite px or NaN, got infinity in row 0"):
        align_face(fit, np.full((68, 2), np.inf))
