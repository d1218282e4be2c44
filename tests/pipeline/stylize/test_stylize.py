"""Drawings of photographs."""

from importlib import import_module

import cv2
import numpy as np
import pytest

import toongeo as tg
from tests.pipeline.stylize.test_velocity_warp import MIRROR
from toongeo.colour.cielab import cielab
from toongeo.pipeline import STYLES
from toongeo.pipeline.parse.hair.segment_hair import segment_hair
from toongeo.pipeline.stylize.style_rules import style_rules

find_hair_module = import_module("toongeo.pipeline.parse.find_hair")  # whose name is its function's, too


def near(landmarks, shape):
    """Box around a face."""
    low, high = landmarks.min(axis=0), landmarks.max(axis=0)
    low, high = np.maximum(low - 0.7 * (high - low), 0).astype(int), (high + 0.3 * (high - low)).astype(int)
    return np.s_[low[1] : min(high[1], shape[0]), low[0] : min(high[0], shape[1])]


@pytest.fixture(scope="module")
def face(cartoon):
    """The astronaut's head alone, at 250 px: quick to draw."""
    img, points = cartoon("astronaut")
    box = near(points, img.shape)
    return np.ascontiguousarray(img[box]), points - [box[1].start, box[0].start]


@pytest.fixture(scope="module")
def drawings(face):
    return {style: tg.stylize(*face, style) for style in STYLES}


def test_every_style_is_warped():
    assert set(style_rules()) == set(STYLES)


def test_drawings_are_of_the_pictures_size_and_follow_the_warp(face, drawings):
    img, points = face
    for style, drawn in drawings.items():
        assert drawn.img.shape == drawn.texture.shape == img.shape and drawn.img.dtype == np.uint8, style
        np.testing.assert_array_equal(drawn.landmarks, drawn.warp.points(points))
        assert not np.array_equal(drawn.img, drawn.texture)


def test_eyes_grow_by_style(face, drawings):
    _, points = face

    def height(p):
        return np.linalg.norm(p[[37, 38, 43, 44]] - p[[41, 40, 47, 46]], axis=1).mean()

    grown = {style: height(drawn.landmarks) / height(points) for style, drawn in drawings.items()}
    assert grown["chibi"] > grown["toon"] > 1.3 > grown["painted"] > 1.05


def test_skin_is_flat_and_keeps_its_lightness(face, drawings):
    img, points = face
    cheek = np.rint(0.5 * (points[31] + points[3])).astype(int)
    patch = np.s_[cheek[1] - 4 : cheek[1] + 5, cheek[0] - 4 : cheek[0] + 5]
    before = cielab(img[patch])
    at = np.rint(drawings["toon"].warp.points(cheek.astype(float))).astype(int)
    after = cielab(drawings["toon"].texture[at[1] - 4 : at[1] + 5, at[0] - 4 : at[0] + 5])
    assert after[..., 0].std() < 0.5 * max(before[..., 0].std(), 1.0) + 0.3
    assert abs(np.median(after[..., 0]) - np.median(before[..., 0])) < 10


def test_ink_is_black_on_white(drawings):
    values = drawings["ink"].img.astype(int)
    ends = (values < 60).all(axis=-1) | (values > 230).all(axis=-1)
    assert ends.mean() > 0.85 and np.ptp(values, axis=-1).max() < 12


def test_no_strength_gives_the_picture_back(face):
    img, points = face
    drawn = tg.stylize(img, points, "chibi", strength=0)
    np.testing.assert_array_equal(drawn.img, img)
    np.testing.assert_array_equal(drawn.texture, img)
    np.testing.assert_array_equal(drawn.landmarks, points)


def test_half_the_strength_shows_the_photograph_through(face, drawings):
    img, points = face
    half = tg.stylize(img, points, "toon", strength=0.5)
    assert np.abs(half.landmarks - points).max() < 0.7 * np.abs(drawings["toon"].landmarks - points).max()
    skin = np.rint(half.landmarks[30]).astype(int)
    assert not np.array_equal(half.img[skin[1], skin[0]], drawings["toon"].img[skin[1], skin[0]])


def test_the_same_picture_gives_the_same_drawing(face, drawings):
    again = tg.stylize(*face, "painted")
    np.testing.assert_array_equal(again.img, drawings["painted"].img)


@pytest.mark.slow
@pytest.mark.parametrize("style", ["toon", "ink"])
def test_a_mirrored_picture_gives_the_mirrored_drawing(face, drawings, style):
    img, points = face
    mirrored = (points * [-1, 1] + [img.shape[1] - 1, 0])[MIRROR]
    other = tg.stylize(np.ascontiguousarray(img[:, ::-1]), mirrored, style).img[:, ::-1]
    assert np.abs(other.astype(int) - drawings[style].img).mean() < 3


@pytest.mark.slow
@pytest.mark.parametrize("style", ["toon", "ink"])
def test_twice_the_resolution_gives_the_same_drawing(face, style):
    """From a face of 220 px on; of smaller ones lines are a pixel wide, and where they fall counts."""
    img, points = (cv2.resize(face[0], None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC), 2 * face[1] + 0.5)
    double = cv2.resize(img, None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC)
    other = cv2.resize(tg.stylize(double, 2 * points + 0.5, style).img, img.shape[1::-1], interpolation=cv2.INTER_AREA)
    assert np.abs(other.astype(int) - tg.stylize(img, points, style).img).mean() < 3


def test_missing_landmarks_are_those_of_the_fit(face):
    img, points = face
    fewer = points.copy()
    fewer[[2, 20, 57]] = np.nan
    drawn = tg.stylize(img, fewer, "toon")
    assert np.isfinite(drawn.landmarks).all()


def test_grey_pictures_stay_grey(face):
    img, points = face
    grey = np.repeat(cv2.cvtColor(img, cv2.COLOR_RGB2GRAY)[..., None], 3, axis=2)
    drawn = tg.stylize(grey, points, "toon").img.astype(int)
    assert np.ptp(drawn, axis=-1).max() < 16


def test_small_pictures_are_drawn(face):
    img, points = face
    factor = 64 / img.shape[0]
    small = cv2.resize(img, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
    assert tg.stylize(small, (points + 0.5) * factor - 0.5, "chibi").img.shape == small.shape


@pytest.mark.slow
def test_huge_pictures_are_drawn_at_a_bounded_size(face):
    img, points = face
    huge = cv2.resize(img, (6000, 6000), interpolation=cv2.INTER_LINEAR)
    scale = np.array([6000 / img.shape[1], 6000 / img.shape[0]])
    drawn = tg.stylize(huge, (points + 0.5) * scale - 0.5, "ink")
    assert drawn.img.shape == huge.shape


def test_what_is_refused(face):
    img, points = face
    with pytest.raises(ValueError, match="style: expected one of toon, chibi, caricature, ink, painted, got 'anime'"):
        tg.stylize(img, points, "anime")
    for strength in (-0.1, 2.5, np.nan, "1"):
        with pytest.raises(ValueError, match=r"strength: expected a number in \[0, 2\]"):
            tg.stylize(img, points, strength=strength)
    with pytest.raises(ValueError, match="img: expected"):
        tg.stylize(img[..., 0], points)
    with pytest.raises(ValueError, match="landmarks"):
        tg.stylize(img, points[:50])


def test_an_avatar_of_a_drawing(cartoon, tmp_path):
    img, points = cartoon("astronaut")
    avatar = tg.make_avatar(img, points, style="toon", hair=False, texture_size=256)
    assert avatar.style is not None
    np.testing.assert_allclose(avatar.style.landmarks, avatar.style.warp.points(points))
    goal = avatar.style.landmarks[36:48]
    placed = avatar.face.project(avatar.face.vertices[avatar.face.landmark_vertices[36:48]])
    assert np.abs(placed - goal).max() < 0.05 * np.ptp(points[:, 0])
    avatar.save(tmp_path / "toon.glb")
    again = tg.load_avatar(tmp_path / "toon.glb")
    np.testing.assert_array_equal(again.face.vertices, avatar.face.vertices)
    assert again.style is None  # the drawing is not kept


def test_the_hair_of_a_photograph_is_that_of_its_avatar(cartoon, monkeypatch):
    img, points = cartoon("astronaut")
    searches = []

    def counted(*arguments, **more):
        searches.append(1)
        return segment_hair(*arguments, **more)

    monkeypatch.setattr(find_hair_module, "segment_hair", counted)
    avatar = tg.make_avatar(img, points, style="chibi", texture_size=256)
    assert len(searches) == 1
    found, moved = avatar.style.hair, avatar.parse.hair
    assert found.mask.shape == moved.mask.shape == img.shape[:2]
    rows, columns = np.nonzero(cv2.erode(found.mask.astype(np.uint8), np.ones((9, 9))))
    at = np.rint(avatar.style.warp.points(np.column_stack([columns, rows]).astype(float))).astype(int)
    inside = (at >= 0).all(axis=1) & (at < img.shape[1::-1]).all(axis=1)
    assert moved.mask[at[inside, 1], at[inside, 0]].mean() > 0.98


def test_whoever_draws_otherwise_is_asked_once(cartoon):
    img, points = cartoon("astronaut")
    asked = []

    def stylizer(picture, landmarks):
        asked.append(landmarks)
        drawn = tg.stylize(picture, landmarks, strength=0)
        return tg.Stylized(255 - picture, landmarks, drawn.warp, 255 - picture)

    avatar = tg.make_avatar(img, points, style=stylizer, hair=False, texture_size=256)
    assert len(asked) == 1 and np.abs(asked[0] - points).max() < 1e-9
    plain = tg.make_avatar(img, points, hair=False, texture_size=256)
    assert np.abs(avatar.texture.astype(int) - plain.texture).mean() > 20

    def wrong(picture, landmarks):
        return tg.Stylized(picture, landmarks[:5], tg.stylize(picture, landmarks, strength=0).warp, picture)

    with pytest.raises(ValueError, match=r"style: expected a texture .* landmarks \(68, 2\)"):
        tg.make_avatar(img, points, style=wrong)
    with pytest.raises(ValueError, match="style: expected one of"):
        tg.make_avatar(img, points, style="oil")
