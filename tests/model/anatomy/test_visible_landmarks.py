"""Jaw points: the outline rule written out on the whole mesh, and weights in closed form."""

import numpy as np
import pytest

from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.visible_landmarks import jaw_weights, visible_landmarks
from toongeo.render import ScaledOrthographicCamera


def outline_by_hand(model, V, view):
    """First vertex of each line whose normal turns away, from normals of the whole mesh."""
    corners = V[model.faces]
    normals = np.zeros_like(V)
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for c in range(3):
        np.add.at(normals, model.faces[:, c], area)
    found = []
    for line in model.contour_lines:
        away = [v for v in line if normals[v] @ view <= 0]
        found.append(away[0] if away else line[-1])
    return found


@pytest.mark.parametrize("yaw", [-60, -25, 0, 10, 45])
@pytest.mark.parametrize("pitch", [-20, 0, 15])
def test_jaw_points_follow_the_outline(model, random_face, yaw, pitch):
    identity, expression = random_face(1)
    rotation = ScaledOrthographicCamera.look(yaw=yaw, pitch=pitch).rotation
    found = visible_landmarks(landmark_basis(model), np.concatenate([identity, expression]), rotation)
    assert found[:17].tolist() == outline_by_hand(model, model.vertices(identity, expression), rotation[2])
    np.testing.assert_array_equal(found[17:], model.landmarks[17:])


def test_turning_mirrors_the_jaw(model):
    basis = landmark_basis(model)
    still = np.zeros(basis.modes.shape[1])
    left, right = (
        visible_landmarks(basis, still, ScaledOrthographicCamera.look(yaw=yaw, pitch=5).rotation)[:17]
        for yaw in (30, -30)
    )
    np.testing.assert_array_equal(model.mirror[left], right[::-1])


def test_a_straight_outline_counts_across_and_little_along():
    points = np.column_stack([np.zeros(17), np.linspace(0, 160, 17)])
    np.testing.assert_allclose(jaw_weights(points, 0.35), np.tile(np.diag([1, 0.35**2]), (17, 1, 1)), atol=1e-15)


def test_weights_turn_with_the_picture():
    angle = np.linspace(0, np.pi, 17)
    points = np.column_stack([80 * np.cos(angle), 100 * np.sin(angle)])
    points[[3, 4, 16]] = np.nan
    Q = np.array([[0.8, -0.6], [0.6, 0.8]])
    np.testing.assert_allclose(jaw_weights(points @ Q.T, 0.2), Q @ jaw_weights(points, 0.2) @ Q.T, atol=1e-14)


def test_missing_points_weigh_nothing_and_a_lonely_one_counts_alike_everywhere():
    points = np.full((17, 2), np.nan)
    assert not jaw_weights(points, 0.35).any()
    points[5] = 3.0
    weights = jaw_weights(points, 0.35)
    np.testing.assert_array_equal(weights[5], np.eye(2))
    assert np.count_nonzero(weights) == 2


def test_points_in_one_place_have_no_tangent():
    np.testing.assert_array_equal(jaw_weights(np.full((17, 2), 4.0), 0.35), np.tile(np.eye(2), (17, 1, 1)))
