import numpy as np
import pytest

from toongeo.render import interpolate, rasterize


def scene():
    rng = np.random.default_rng(0)
    points = rng.uniform(-5.0, 45.0, (90, 2))
    return points, np.arange(90).reshape(-1, 3)


def test_linear_functions_are_exact():
    points, F = scene()
    fragments = rasterize(points, F, 40, 40)
    attributes = points @ np.array([[0.3, -2.0], [1.5, 0.25]]) + [4.0, -7.0]
    y, x = np.nonzero(fragments.mask)
    expected = np.column_stack([x, y]) @ np.array([[0.3, -2.0], [1.5, 0.25]]) + [4.0, -7.0]
    np.testing.assert_allclose(interpolate(fragments, F, attributes)[y, x], expected, atol=1e-3)


def test_a_constant_stays_constant_and_the_rest_is_zero():
    points, F = scene()
    fragments = rasterize(points, F, 40, 40)
    np.testing.assert_allclose(interpolate(fragments, F, np.full(90, 3.5)), 3.5 * fragments.mask, atol=1e-5)


def test_type_and_shape_follow_the_attributes():
    points, F = scene()
    fragments = rasterize(points, F, 7, 9)
    assert interpolate(fragments, F, np.zeros((90, 4), np.float32)).dtype == np.float32
    assert interpolate(fragments, F, np.zeros((90, 4))).shape == (7, 9, 4)
    assert interpolate(fragments, F, np.zeros(90, int)).dtype == np.float64
    assert interpolate(fragments, F, np.zeros(90)).shape == (7, 9)
    assert interpolate(rasterize(points, F[:0], 7, 9), F[:0], np.zeros((0, 2))).shape == (7, 9, 2)


def test_other_corners_of_the_same_faces():
    points, F = scene()
    fragments = rasterize(points, F, 20, 20)
    shuffle = np.random.default_rng(1).permutation(90)
    values, renamed = np.empty((90, 2)), shuffle[F]
    values[shuffle] = points
    assert (interpolate(fragments, renamed, values) == interpolate(fragments, F, points)).all()


def test_bad_input():
    points, F = scene()
    fragments = rasterize(points, F, 20, 20)
    with pytest.raises(ValueError, match="attributes: expected shape"):
        interpolate(fragments, F, np.zeros((90, 2, 2)))
    with pytest.raises(ValueError, match=r"F: expected shape \(m, 3\)"):
        interpolate(fragments, F.ravel(), points)
    with pytest.raises(ValueError, match="F: expected the faces that were rasterized, got only 2"):
        interpolate(fragments, F[:2], points)
    with pytest.raises(ValueError, match=r"F: expected indices in \[0, 80\), got 0 to 89"):
        interpolate(fragments, F, points[:80])
