import numpy as np
import pytest

from toongeo.pipeline import aim_eyes, bake_eyes, fit_eyes
from toongeo.pipeline.texture.eyes.bake_eyes import WHITE, _disc_fragments
from toongeo.pipeline.texture.eyes.find_irises import Iris
from toongeo.pipeline.texture.face_picture import EYE_LEFT, EYE_RIGHT, opening_mask
from toongeo.render import sample_image, uv_to_px


@pytest.fixture(scope="module")
def stages(cartoon, aligned, transferred):
    img, face = cartoon("manga_girl")[0], aligned("manga_girl")
    return img, face, fit_eyes(face, transferred("manga_girl"))


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


IRIS_RGB, WHITE_RGB, SKIN_RGB = np.array([40, 70, 160]), np.array([240, 236, 230]), np.array([220, 180, 160])


@pytest.fixture(scope="module")
def half_covered(stages):
    """A picture of eyes whose lids cover the upper half of the iris, and what they are drawn from."""
    _, face, _ = stages
    landmarks = face.project(face.vertices[face.landmark_vertices])
    rims = (EYE_LEFT, EYE_RIGHT)
    height, width = np.ceil(landmarks.max(0)[::-1] + 50).astype(int)
    img = np.full((height, width, 3), SKIN_RGB, np.uint8)
    y, x = np.mgrid[:height, :width]
    irises = []
    for side in (0, 1):
        points = landmarks[np.unique(np.concatenate(rims[side]))]
        opening = opening_mask(landmarks, rims[side], (height, width))
        rows = np.flatnonzero(opening[:, round(points[:, 0].mean())])
        radius = 0.3 * np.ptp(rows)
        centre = np.array([points[:, 0].mean(), rows.min() + 0.12 * np.ptp(rows)])  # the lid hides what is above
        inside = np.hypot(x - centre[0], y - centre[1]) < radius
        img[opening] = WHITE_RGB
        img[opening & inside] = IRIS_RGB
        irises.append(Iris(centre, np.array([radius, radius]), 1.0))
    return img, tuple(irises)


def test_the_part_of_an_iris_that_a_lid_hides_is_completed(stages, half_covered, blank):
    _, face, eyes = stages
    img, irises = half_covered
    eyes = aim_eyes(face, eyes, irises)
    atlas = bake_eyes(img, face, eyes, blank, irises)
    without = bake_eyes(img, face, eyes, blank)
    for side, iris in enumerate(irises):
        turned = eyes.looking_as_drawn(side)
        away = np.linalg.norm((face.project(turned) - iris.centre) / iris.radii, axis=1)
        front = face.camera.view(turned - eyes.centres[side])[:, 2] > 0.35 * eyes.radii[side]
        texel = uv_to_px(eyes.templates[side].uv, 512, 512)
        above = face.project(turned)[:, 1] < iris.centre[1] - 0.4 * iris.radii[1]
        hidden = front & above & (away < 0.85)
        assert hidden.sum() > 3
        assert np.abs(sample_image(atlas, texel[hidden]) - IRIS_RGB).max() < 12
        assert np.abs(sample_image(without, texel[hidden]) - WHITE).max() < 12
        beside = front & (away > 1.4)
        assert np.abs(sample_image(atlas, texel[beside]) - WHITE_RGB).max() < 20  # the rim is soft
