"""A picture in the colours of another."""

import numpy as np
import pytest

import toongeo as tg
from toongeo.colour.cielab import cielab
from toongeo.pipeline.stylize.appearance.line_weight import drawn_lines
from toongeo.pipeline.stylize.face_frame import face_frame
from toongeo.pipeline.stylize.match_style import _mapped


def test_mean_and_covariance_become_those_of_the_reference(rng):
    source = (rng.normal(size=(5000, 3)) @ np.diag([20, 8, 5]) + [50, 5, 10]).astype(np.float32)
    target = (rng.normal(size=(4000, 3)) @ np.array([[12, 0, 0], [6, 4, 0], [1, 2, 9]]) + [70, -10, 3]).astype(
        np.float32
    )
    moved = _mapped(source[None], source, target, target)[0]
    np.testing.assert_allclose(moved.mean(axis=0), target.mean(axis=0), atol=1e-2)
    np.testing.assert_allclose(np.cov(moved.T), np.cov(target.T), atol=2.5)


def test_the_map_is_symmetric_and_its_own_colours_stay(rng):
    """The least effort between Gaussians is a symmetric map; between equal ones it is none."""
    source = rng.normal(size=(900, 3)).astype(np.float32) * 9
    np.testing.assert_allclose(_mapped(source[None], source, source, source)[0], source, atol=1e-3)


def test_skin_takes_the_references_colour(cartoon):
    img, points = cartoon("bad_guy")
    other, others = cartoon("manga_girl")
    result = tg.match_style(img, other, points, others)
    cheek, there = (np.rint(p[[2, 31]].mean(axis=0)).astype(int) for p in (points, others))
    goal = other[there[1], there[0]].astype(int)
    before, after = img[cheek[1], cheek[0]].astype(int), result[cheek[1], cheek[0]].astype(int)
    assert np.abs(after - goal).sum() < 0.5 * np.abs(before - goal).sum()


def test_a_photograph_gets_the_lines_and_tones_of_a_drawing(cartoon):
    img, points = cartoon("astronaut")
    other, others = cartoon("manga_girl")
    result = tg.match_style(img, other, points, others)
    size, size_there = face_frame(points).size, face_frame(others).size
    before, after, goal = (
        drawn_lines(cielab(picture), length) for picture, length in ((img, size), (result, size), (other, size_there))
    )
    assert abs(after.width - goal.width) < max(abs(before.width - goal.width), 0.004)
    assert after.cover.mean() > 0.005
    cheek = np.rint(points[[2, 31]].mean(axis=0)).astype(int)
    patch = cielab(result[cheek[1] - 4 : cheek[1] + 5, cheek[0] - 4 : cheek[0] + 5])
    flat = np.abs(patch[..., 0] - np.median(patch[..., 0])) < 1.5  # one tone, as in the drawing, but for lines
    assert flat.mean() > 0.7
    eye = np.rint(points[[37, 41]].mean(axis=0)).astype(int)
    assert np.abs(result[eye[1], eye[0]].astype(int) - img[eye[1], eye[0]]).max() < 90  # it is still there


@pytest.mark.parametrize("name", ["moustache_man", "astronaut"])
def test_a_picture_in_its_own_style_stays(cartoon, name):
    """Lines of a drawing, and the shading of a photograph, are not done anew."""
    img, points = cartoon(name)
    off = np.abs(tg.match_style(img, img, points, points).astype(int) - img).max(axis=2)
    assert off.mean() < 0.3 and (off > 8).mean() < 0.003


def test_what_is_refused(cartoon):
    img, points = cartoon("bad_guy")
    with pytest.raises(ValueError, match="reference: expected"):
        tg.match_style(img, img[..., 0], points, points)
    with pytest.raises(ValueError, match="landmarks"):
        tg.match_style(img, img, points[:3], points)
