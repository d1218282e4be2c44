import numpy as np
import pytest

from toongeo.pipeline import align_face, bake_eyes, build_rig, fit_3dmm, fit_eyes
from toongeo.pipeline.texture.bake_eyes import WHITE, _disc_fragments
from toongeo.render import sample_image, uv_to_px


@pytest.fixture(scope="module")
def stages(cartoon):
    img, landmarks = cartoon("manga_girl")
    face = align_face(fit_3dmm(img, landmarks), landmarks)
    return img, face, fit_eyes(face, build_rig(face))


@pytest.fixture(scope="module")
def blank():
    return np.full((512, 512, 3), 90, np.uint8)


def test_only_the_discs_change_and_nothing_is_written_to(stages, blank):
    img, face, eyes = stages
    atlas = bake_eyes(img, face, eyes, blank)
    assert (blank == 90).all()
    discs = np.zeros((512, 512), bool)
    for side in (0, 1):
        rows, columns = np.nonzero(_disc_fragments(eyes.templates[side], 512).mask)
        discs[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1] = True
    assert (atlas[~discs] == 90).all() and (atlas[discs] != 90).any(1).mean() > 0.9


def test_the_drawn_eye_is_on_the_eyeball(stages, blank):
    """Vertices of the sphere that project well inside the drawn eye have the picture's colour there."""
    img, face, eyes = stages
    atlas = bake_eyes(img, face, eyes, blank)
    landmarks = face.project(face.vertices[face.landmark_vertices])
    for side, corners in ((0, range(42, 48)), (1, range(36, 42))):
        middle = landmarks[list(corners)].mean(0)
        reach = 0.25 * np.ptp(landmarks[list(corners)], axis=0).min()
        px = face.project(eyes.vertices(side))
        inside = (np.linalg.norm(px - middle, axis=1) < reach) & (eyes.templates[side].vertices[:, 2] > 0.3)
        texels = sample_image(atlas, uv_to_px(eyes.templates[side].uv[inside], 512, 512))
        assert inside.sum() > 5
        assert np.median(np.abs(texels - sample_image(img, px[inside]))) < 12


def test_what_is_not_seen_is_white(stages, blank):
    img, face, eyes = stages
    atlas = bake_eyes(img, face, eyes, blank)
    for eye in eyes.templates:
        back = (eye.vertices[:, 2] < -0.5) & (eye.vertices[:, 2] > -0.9)  # not the edge of the disc
        texels = sample_image(atlas, uv_to_px(eye.uv[back], 512, 512))
        assert np.abs(texels - WHITE).max() <= 1


def test_bad_arguments_are_named(stages, blank):
    img, face, eyes = stages
    with pytest.raises(ValueError, match=r"img: expected \(H, W, 3\) uint8 RGB, got float64"):
        bake_eyes(img / 255, face, eyes, blank)
    with pytest.raises(
        ValueError, match=r"texture: expected \(size, size, 3\) uint8, got uint8 of shape \(512, 100, 3\)"
    ):
        bake_eyes(img, face, eyes, blank[:, :100])
