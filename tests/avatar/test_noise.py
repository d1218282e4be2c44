"""Noisy landmarks on the whole way."""

import sys

import numpy as np
import pytest

from toongeo import align_face, fit_3dmm, fit_caricature, load_avatar, make_avatar
from toongeo.metrics import mesh_quality
from toongeo.protocols import LandmarkDetection

THROWN = [24, 60]


def crossing(face):
    return len(mesh_quality(face.vertices, face.faces[face.region("face")[face.faces].all(1)]).intersecting)


@pytest.fixture(scope="module")
def wrong(cartoon):
    """Picture, and landmarks of which two are half an outer-eye distance off."""
    img, landmarks = cartoon("moustache_man")
    points = landmarks.copy()
    points[THROWN] += 0.5 * np.linalg.norm(points[36] - points[45])
    return img, points


def test_clean_points_are_aligned_as_without_the_model_of_noise(cartoon, fits, aligned):
    name = "blue_girl"
    exact = align_face(fits(name), cartoon(name)[1], noise=0)
    assert exact.vertices.tobytes() == aligned(name).vertices.tobytes()
    assert aligned(name).report.noise is None


def test_an_alignment_folds_no_more_and_says_what_it_did(wrong):
    fit = fit_3dmm(None, wrong[1])
    before, after = (align_face(fit, wrong[1], noise=noise) for noise in (0, "auto"))
    assert crossing(before) > 50 and crossing(after) == 0
    assert before.report.noise is None and before.report.max_px < 0.1
    assert after.report.noise.rejected == tuple(THROWN)
    assert after.report.max_px > 0.3 * np.linalg.norm(wrong[1][36] - wrong[1][45])


def test_a_caricature_does_not_meet_what_is_thrown_off(wrong, cartoon):
    face = fit_caricature(None, wrong[1], iterations=1)
    off = np.linalg.norm(face.project(face.vertices[face.landmark_vertices]) - cartoon("moustache_man")[1], axis=1)
    assert off.max() < 0.1 * np.linalg.norm(wrong[1][36] - wrong[1][45])


@pytest.fixture(scope="module")
def detected(wrong):
    """An avatar of landmarks that a detector found so."""
    img, points = wrong
    with pytest.MonkeyPatch.context() as patch:
        found = LandmarkDetection(points, np.full(68, 0.9), 0.9)
        patch.setattr(sys.modules["toongeo.avatar.make_avatar"], "detect_landmarks", lambda img, detector=None: found)
        return make_avatar(img, hair=False, texture_size=64)


def test_an_avatar_of_detected_points_does_so_too(detected):
    assert detected.face.report.noise.rejected == tuple(THROWN)
    assert any("put where the others have them: 24, 60" in warning for warning in detected.report.warnings)
    assert crossing(detected.face) == 0
    assert detected.report.aligned["mouth"] > 0.05  # against the points that were given


def test_a_file_keeps_what_was_done(detected, tmp_path):
    detected.save(tmp_path / "noisy.glb")
    assert load_avatar(tmp_path / "noisy.glb").face.report.noise == detected.face.report.noise


def test_nonsense_is_refused_before_the_work(wrong):
    with pytest.raises(ValueError, match="noise: expected 'auto' or a number"):
        make_avatar(*wrong, noise="much")
