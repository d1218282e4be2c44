"""All landmarks from a few."""

import numpy as np
import pytest

from toongeo.app.editor.editor_settings import editor_settings
from toongeo.app.editor.place_landmarks import place_landmarks
from toongeo.render import ScaledOrthographicCamera

ORDER = [click["point"] for click in editor_settings()["clicks"]]


def clicked(points, count):
    clicks = np.full((68, 2), np.nan)
    clicks[ORDER[:count]] = points[ORDER[:count]]
    return clicks


@pytest.mark.parametrize("count", [2, 3, 5])
def test_the_mean_face_from_the_front_is_found_by_few_clicks(model, count):
    """It is what a similarity lays onto the clicks, so nothing is missed."""
    camera = ScaledOrthographicCamera.look(roll=25.0, size=300)
    points = camera.project(model.mean[model.landmarks])
    np.testing.assert_allclose(place_landmarks(clicked(points, count)), points, atol=1e-8)


@pytest.mark.parametrize("count", [2, 6, 20])
def test_clicks_stay_where_they_are(truth, count):
    clicks = clicked(truth, count)
    placed = place_landmarks(clicks)
    given = np.isfinite(clicks[:, 0])
    np.testing.assert_array_equal(placed[given], truth[given])
    assert np.isfinite(placed).all()


def test_it_moves_with_the_picture(truth):
    """Equivariant under a shift, a turn and another size of the picture."""
    turn = 1.7 * np.array([[np.cos(0.4), -np.sin(0.4)], [np.sin(0.4), np.cos(0.4)]])
    for count, tolerance in ((3, 1e-9), (12, 0.05)):
        placed = place_landmarks(clicked(truth, count))
        turned = place_landmarks(clicked(truth @ turn.T + [30, -20], count))
        np.testing.assert_allclose(turned, placed @ turn.T + [30, -20], atol=tolerance)


def test_more_clicks_leave_less(cartoon):
    errors = []
    for name in ("moustache_man", "beethoven", "astronaut"):
        points = cartoon(name)[1]
        others = np.setdiff1d(np.arange(17, 68), ORDER)
        unit = np.linalg.norm(points[36] - points[45])
        placed = [place_landmarks(clicked(points, count))[others] for count in (2, 6, 20)]
        errors.append([np.linalg.norm(found - points[others], axis=1).mean() / unit for found in placed])
    few, six, twenty = np.mean(errors, axis=0)
    assert twenty < six < few and six < 0.13 and twenty < 0.06


def test_too_few():
    with pytest.raises(ValueError, match="clicks: expected at least 2 known points, got 1"):
        place_landmarks([[5, 5]] + [[np.nan, np.nan]] * 67)
    clicks = np.full((68, 2), np.nan)
    clicks[[36, 45]] = 10, 10
    with pytest.raises(ValueError, match="clicks: expected points of a face, but they lie in one place"):
        place_landmarks(clicks)
