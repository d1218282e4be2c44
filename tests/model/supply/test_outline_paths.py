"""Contour lines found from a shape."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from toongeo.model import MorphableModel
from toongeo.model.anatomy.landmark_basis import landmark_basis
from toongeo.model.anatomy.visible_landmarks import visible_landmarks
from toongeo.model.ibug68 import PARTS
from toongeo.model.supply.outline_paths import outline_paths
from toongeo.render import ScaledOrthographicCamera


@pytest.mark.parametrize("yaw", [-30.0, -15.0, 0.0, 15.0, 30.0])
def test_the_outline_is_found_where_the_lines_drawn_by_hand_find_it(model, yaw):
    basis = landmark_basis(replace(model, contour_lines=outline_paths(model, model.landmarks)))
    by_hand = landmark_basis(model)
    R = ScaledOrthographicCamera.look(yaw=yaw).rotation
    c = np.zeros(basis.modes.shape[1])
    found, wanted = (model.mean[visible_landmarks(b, c, R)] @ R.T for b in (basis, by_hand))
    for k in range(3, 14):  # across the outline: along it they may differ
        near = np.linalg.norm(wanted[:17, :2] - found[k, :2], axis=1).argmin()
        tangent = wanted[min(near + 1, 16), :2] - wanted[max(near - 1, 0), :2]
        across = np.array([-tangent[1], tangent[0]]) / np.linalg.norm(tangent)
        assert abs((found[k, :2] - wanted[near, :2]) @ across) < 6  # mm


def test_found_lines_run_like_those_drawn_by_hand(model):
    found = outline_paths(model, model.landmarks)
    for k in range(3, 14):
        near = cKDTree(model.mean[found[k]]).query(model.mean[model.contour_lines[k]])[0]
        assert np.median(near) < 12  # mm; jaw points are about 20 mm apart


def test_a_model_without_lines_gets_them(model):
    bare = MorphableModel.from_arrays(model.mean, model.faces, landmarks=model.landmarks)
    slid = bare.with_contours()
    assert not bare.has("contours") and slid.has("contours")
    np.testing.assert_array_equal(slid.landmarks[17:], bare.landmarks[17:])
    assert all(len(line) > 3 for line in slid.contour_lines)
    jaw = slid.mean[slid.landmarks[PARTS["jaw"]]]
    assert (np.diff(jaw[2:15, 0]) > 0).all() and abs(jaw[8, 0]) < 10 and (jaw[:7, 1] > jaw[8, 1]).all()
    with pytest.raises(ValueError, match="model: expected one with landmarks"):
        MorphableModel.from_arrays(model.mean, model.faces).with_contours()
