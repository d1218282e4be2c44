import dataclasses

import numpy as np
import pytest

from toongeo.pipeline import aim_eyes, bake_eyes, fit_eyes
from toongeo.pipeline.texture.eyes.eye_disc import EyeDisc, eye_disc
from toongeo.pipeline.texture.eyes.find_irises import Iris
from toongeo.pipeline.texture.eyes.sclera import LIGHTEST_WHITE, hollow, white_of, white_of_lightest
from toongeo.pipeline.texture.eyes.whole_iris import whole_iris
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
        disc = eye_disc(img, face, eyes, side, None, 512)
        rows, columns = disc.rows, disc.columns
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
        beside = front & (away > 1.4)
        shade = hollow(eyes.templates[side].vertices)
        for made, where in ((atlas, beside), (without, hidden)):  # the rim is soft
            assert np.abs(sample_image(made, texel[where]) - shade[where] * WHITE_RGB).max() < 20


def test_lashes_drawn_over_the_white_stay_where_they_are(stages, half_covered, blank):
    """A dark line across the white beside the iris is not on the eyeball, which turns."""
    _, face, eyes = stages
    img, irises = half_covered
    eyes = aim_eyes(face, eyes, irises)
    lashed = img.copy()
    for iris in irises:
        x = round(iris.centre[0] + 1.4 * iris.radii[0])
        lashed[:, x : x + 2] = 20
    clean, atlas = (bake_eyes(picture, face, eyes, blank, irises) for picture in (img, lashed))
    assert np.abs(atlas.astype(int) - clean).max() < 45 and (lashed != img).any()


def test_an_eye_without_an_iris_takes_the_other_ones(stages, half_covered, blank):
    _, face, eyes = stages
    img, irises = half_covered
    eyes = aim_eyes(face, eyes, (irises[0], None))
    atlas = bake_eyes(img, face, eyes, blank, (irises[0], None))
    left, right = (
        atlas[disc.rows.min() : disc.rows.max() + 1, disc.columns.min() : disc.columns.max() + 1]
        for disc in (eye_disc(img, face, eyes, side, None, 512) for side in (0, 1))
    )
    rows, columns = (slice(0, min(pair)) for pair in zip(left.shape[:2], right.shape[:2], strict=True))
    assert np.abs(left[rows, columns].astype(int)[:, ::-1] - right[rows, columns]).mean() < 6


def test_behind_shut_lids_is_the_eye_of_the_model(stages, blank):
    """Landmarks whose lids meet show nothing of an eye."""
    img, face, eyes = stages
    V = face.vertices.copy()
    for upper, lower in ((37, 41), (38, 40), (43, 47), (44, 46)):
        V[face.landmark_vertices[upper]] = V[face.landmark_vertices[lower]]
    shut = dataclasses.replace(face, vertices=V)
    atlas = bake_eyes(img, shut, eyes, blank)
    disc = eye_disc(img, shut, eyes, 0, None, 512)
    assert not disc.seen.any()
    np.testing.assert_allclose(atlas[disc.rows, disc.columns], disc.default, atol=1)


def _disc(rng, count=4000):
    """Texels spread over the front of an eyeball, with an iris of 0.4 in front."""
    xy = rng.uniform(-0.8, 0.8, (count, 2))
    xy = xy[np.hypot(*xy.T) < 0.9]
    unit = np.column_stack([xy, np.sqrt(1 - (xy**2).sum(1))])
    away, angle = np.hypot(*xy.T) / 0.4, np.arctan2(xy[:, 1], xy[:, 0])
    whole = np.ones(len(xy), bool)
    return EyeDisc(*np.zeros((2, len(xy)), int), unit, np.zeros_like(unit), whole, away, angle, unit, away < 1)


def test_a_white_is_linear_over_the_eyeball_and_bears_lashes(rng):
    disc = _disc(rng)
    white = np.array([210.0, 205, 200]) + np.outer(disc.unit[:, 0], [20.0, 18, 15]) + 10 * disc.unit[:, 1:2]
    lashes = rng.uniform(size=len(white)) < 0.15
    colours = np.where(lashes[:, None], 30.0, np.where(disc.away[:, None] < 1, [40.0, 60, 90], white))
    found = white_of(dataclasses.replace(disc, colours=colours))
    bare = disc.away > 1.12
    error = (found.at(disc.unit) / hollow(disc.unit) - white)[bare]
    assert np.abs(error).mean() < 2 and np.percentile(np.abs(error), 95) < 8
    mirrored = disc.unit * [-1, 1, 1]
    np.testing.assert_allclose(found.at(mirrored, mirrored=True), found.at(disc.unit))


def test_no_white_is_found_where_none_is_drawn(rng):
    disc = _disc(rng)
    dark = dataclasses.replace(disc, colours=np.full_like(disc.unit, 40.0))
    hidden = dataclasses.replace(disc, seen=np.zeros(len(disc.unit), bool))
    assert white_of(dark) is None and white_of(hidden) is None
    assert (white_of_lightest(dark) <= 90).all()
    np.testing.assert_allclose(white_of_lightest(hidden), LIGHTEST_WHITE * hollow(disc.unit))


def test_the_hidden_half_of_a_round_iris_is_the_seen_half(rng):
    """Colours that depend on the radius alone come back exactly where they are hidden; rays go around in part."""
    disc = _disc(rng)
    round_ = 60 + 100 * disc.away[:, None] * np.array([1.0, 0.8, 0.5])
    below = disc.unit[:, 1] < 0
    iris = (disc.away < 0.97) & (disc.away > 0.2)  # of the innermost rings too few points are seen here
    found = whole_iris(dataclasses.replace(disc, colours=np.where(below[:, None], round_, 255.0), seen=below))
    assert np.percentile(np.abs(found - round_)[iris], 99) < 6  # rings are joined linearly, and few points fall in each
    assert whole_iris(dataclasses.replace(disc, seen=np.zeros(len(below), bool))) is None
    rays = 10 * np.cos(2 * disc.angle)[:, None]  # alike in all four quarters
    rayed = whole_iris(dataclasses.replace(disc, colours=round_ + rays, seen=below))
    share = np.polyfit(np.broadcast_to(rays, rayed.shape)[iris].ravel(), (rayed - found)[iris].ravel(), 1)[0]
    assert 0.5 < share < 0.8
