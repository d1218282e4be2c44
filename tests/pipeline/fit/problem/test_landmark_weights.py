"""Weights of the landmarks: their noise as the pose shows it, what is turned away, and a misfit that all share."""

import numpy as np
import pytest

from toongeo.model.ibug68 import INNER, MIRROR, PARTS
from toongeo.pipeline.fit.fit_options import FitOptions
from toongeo.pipeline.fit.problem.landmark_weights import evened_weights, landmark_weights
from toongeo.render import ScaledOrthographicCamera

FLIP = np.diag([-1.0, 1.0])


def weights_at(model, yaw):
    camera = ScaledOrthographicCamera.look(yaw=yaw)
    points = camera.project(model.mean[model.landmarks]) * [1, -1]
    return landmark_weights(points, model, camera.rotation, FitOptions())


def test_seen_from_the_front_a_weight_is_the_precision_of_its_point(model):
    weights = weights_at(model, 0.0)
    covariance = model.prior.landmark_covariance[:, :2, :2] + np.eye(2)
    product = weights[INNER] @ covariance[INNER]
    np.testing.assert_allclose(product, product[0, 0, 0] * np.broadcast_to(np.eye(2), product.shape), atol=1e-6)
    assert np.trace(weights[INNER], axis1=1, axis2=2).mean() == pytest.approx(2)


def test_without_known_noise_inner_points_weigh_one_and_the_jaw_as_the_options_say(artist):
    weights = weights_at(artist, 0.0)
    np.testing.assert_allclose(weights[INNER], np.broadcast_to(np.eye(2), (51, 2, 2)))
    np.testing.assert_allclose(np.linalg.eigvalsh(weights[PARTS["jaw"]])[:, 1], FitOptions().jaw.weight)


def test_jaw_points_that_are_turned_away_weigh_a_tenth(artist):
    weights = np.linalg.eigvalsh(weights_at(artist, 75.0))[:, 1]  # the subject's left is out of sight
    np.testing.assert_allclose(weights[PARTS["jaw"][:8]], FitOptions().jaw.weight)
    np.testing.assert_allclose(weights[PARTS["jaw"][-3:]], 0.1 * FitOptions().jaw.weight)


def test_mirrored_poses_weigh_mirrored_points_alike(model):
    left, right = weights_at(model, 40.0), weights_at(model, -40.0)
    np.testing.assert_allclose(FLIP @ right[MIRROR] @ FLIP, left, rtol=1e-4, atol=1e-6)


def test_a_shared_variance_adds_to_each_point_s(rng):
    half = rng.normal(0, 1, (5, 2, 2))
    covariance = half @ half.transpose(0, 2, 1) + np.eye(2)
    unit, shared = 90.0, 7.0
    found = evened_weights(np.linalg.inv(covariance) / unit**2, shared, unit)
    np.testing.assert_allclose(found, 8 * np.linalg.inv(covariance + 7 * np.eye(2)) / unit**2)
    np.testing.assert_allclose(evened_weights(found, 0.0, unit), found)
    assert not evened_weights(np.zeros((1, 2, 2)), shared, unit).any()
