"""Missing points of open curves."""

import numpy as np

from toongeo.model.ibug68 import PARTS
from toongeo.pipeline.align.align_face import align_face
from toongeo.pipeline.align.noise.curve_points import curve_points, with_curve_points
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm


def cubic():
    t = np.arange(68.0)
    return np.column_stack([3 * t - 0.1 * t**2, 0.01 * t**3 - t])


def test_cubics_come_back_where_both_neighbours_are_there():
    points = cubic()
    found = curve_points(points)
    inner = [*range(2, 15), 19, 24, 33]
    np.testing.assert_allclose(found[inner], points[inner], atol=1e-9)
    ends = [0, 16, 17, 21, 22, 26, 27, 30, 31, 35]
    assert np.isnan(found[[*ends, *range(36, 68)]]).all()


def test_one_missing_beyond_costs_a_degree_and_one_missing_beside_the_point():
    points = np.column_stack([np.arange(68.0), np.arange(68.0) ** 2])
    points[[5, 7]] = np.nan
    found = curve_points(points)
    np.testing.assert_allclose(found[[5, 7]], [[5, 25], [7, 49]])
    assert np.isnan(found[[4, 6, 8]]).all()
    points[3] = np.nan  # of 5 only 4 and 6 are left
    assert np.isnan(curve_points(points)[5]).all() and np.isfinite(curve_points(points)[7]).all()


def test_points_that_are_there_stay_bit_for_bit():
    points, away = cubic(), cubic() + 9
    assert with_curve_points(points, away) is points
    fewer = points.copy()
    fewer[[5, 19, 40]] = np.nan
    filled = with_curve_points(fewer, away)
    np.testing.assert_allclose(filled[5], points[5])
    np.testing.assert_allclose(filled[19], (points[19] + away[19]) / 2)
    assert np.isnan(filled[40]).all()
    np.testing.assert_array_equal(np.delete(filled, [5, 19, 40], axis=0), np.delete(points, [5, 19, 40], axis=0))


def test_a_mirrored_face_is_filled_in_alike():
    from toongeo.model.ibug68 import MIRROR

    points = cubic() + np.random.default_rng(2).normal(0, 1, (68, 2))
    mirrored = (points * [-1, 1])[MIRROR]
    np.testing.assert_allclose((curve_points(points) * [-1, 1])[MIRROR], curve_points(mirrored), atol=1e-9)


def test_the_face_goes_to_the_point_that_was_filled_in(cartoon):
    points = cartoon("astronaut")[1].copy()
    fewer = points.copy()
    fewer[PARTS["jaw"][4]] = np.nan
    face = align_face(fit_3dmm(None, fewer), fewer)
    found = face.project(face.vertices)[face.landmark_vertices[4]]
    np.testing.assert_allclose(found, curve_points(fewer)[4], atol=0.05)
    assert np.linalg.norm(found - points[4]) < 0.05 * np.linalg.norm(points[36] - points[45])
