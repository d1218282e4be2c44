"""What is special about a face."""

import numpy as np

from toongeo import fit_3dmm
from toongeo.pipeline.stylize.exaggerated import exaggerated


def mean_points(fit):
    model = fit.model
    V = model.vertices(np.zeros_like(fit.identity), fit.expression)
    return fit.camera.project(V[fit.landmark_vertices])


def test_the_mean_face_has_nothing_special(fits):
    fit = fits("astronaut")
    np.testing.assert_allclose(exaggerated(mean_points(fit), fit), 0, atol=1e-9)


def test_a_similarity_is_not_special(fits):
    fit = fits("blue_girl")
    angle = 0.4
    turn = 1.7 * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    np.testing.assert_allclose(exaggerated(mean_points(fit) @ turn.T + [30, -80], fit), 0, atol=1e-8)


def test_deviations_are_kept_but_for_their_similarity(fits):
    """A second laying on finds nothing more to take away."""
    fit = fits("astronaut")
    special = exaggerated(mean_points(fit) + np.random.default_rng(0).normal(size=(68, 2)) * 4, fit)
    assert 2 < special.std() < 6
    again = exaggerated(mean_points(fit) + special, fit)
    np.testing.assert_allclose(again, special, atol=0.2)


def test_it_is_of_this_picture(cartoon):
    img, points = cartoon("moustache_man")
    assert np.abs(exaggerated(points, fit_3dmm(img, points))).max() > 3
