"""The guided filter against its definition, and against OpenCV's."""

import cv2
import numpy as np
import pytest

from toongeo.pipeline.parse.guided_filter import guided_filter


def slow_reference(guide, plane, radius, softness):
    """A linear system a window (He et al. 2013, Eqs. 19-21), in float64."""
    h, w = plane.shape
    pad = ((radius, radius), (radius, radius), (0, 0))
    colours = np.pad(guide.astype(float), pad, mode="symmetric")
    values = np.pad(plane.astype(float)[..., None], pad, mode="symmetric")
    side = 2 * radius + 1
    fits = np.zeros((h, w, 4))
    for y, x in np.ndindex(h, w):
        window = np.s_[y : y + side, x : x + side]
        colour, value = colours[window].reshape(-1, 3), values[window].ravel()
        covariance = np.cov(colour.T, bias=True) + softness * np.eye(3)
        slope = np.linalg.solve(covariance, ((colour - colour.mean(0)) * (value - value.mean())[:, None]).mean(0))
        fits[y, x] = [*slope, value.mean() - slope @ colour.mean(0)]
    fits = np.pad(fits, pad, mode="symmetric")
    means = np.array([[fits[y : y + side, x : x + side].mean((0, 1)) for x in range(w)] for y in range(h)])
    return (means[..., :3] * guide).sum(2) + means[..., 3]


@pytest.mark.parametrize(("radius", "shape"), [(1, (14, 17)), (3, (20, 12))])
def test_agrees_with_a_system_a_window(radius, shape):
    rng = np.random.default_rng(radius)
    guide, plane = rng.random((*shape, 3), dtype=np.float32), rng.random(shape, dtype=np.float32)
    found = guided_filter(guide, plane, radius, 0.02)
    np.testing.assert_allclose(found, slow_reference(guide, plane, radius, 0.02), atol=2e-5)
    assert found.dtype == np.float32


@pytest.mark.parametrize("width", [336, 335, 177])
@pytest.mark.parametrize("radius", [2, 9])
def test_agrees_with_opencv(radius, width, cartoon):
    if not hasattr(getattr(cv2, "ximgproc", None), "guidedFilter"):
        pytest.skip("this OpenCV has no contributed modules")
    img, _ = cartoon("moustache_man")
    guide = np.ascontiguousarray(img[:, :width].astype(np.float32) / 255)
    mask = (guide[..., 0] > 0.5).astype(np.float32)
    expected = cv2.ximgproc.guidedFilter(guide, mask, radius, 1e-3)
    found = guided_filter(guide, mask, radius, 1e-3)
    whole = width // 4 * 4  # OpenCV adds in another order in what is left of four columns, and a radius around
    np.testing.assert_array_equal(found[:, : whole - 2 * radius], expected[:, : whole - 2 * radius])
    np.testing.assert_allclose(found, expected, atol=1e-5)


def test_a_plane_that_is_affine_in_the_colours_is_kept():
    rng = np.random.default_rng(5)
    guide = rng.random((30, 40, 3), dtype=np.float32)
    plane = guide @ np.float32([0.5, -0.3, 0.8]) + np.float32(0.1)
    np.testing.assert_allclose(guided_filter(guide, plane, 4, 1e-6), plane, atol=1e-3)


def test_where_the_guide_is_of_one_colour_means_of_means_remain():
    plane = np.random.default_rng(6).random((20, 20), dtype=np.float32)
    found = guided_filter(np.full((20, 20, 3), 0.5, np.float32), plane, 2, 1e-3)
    mean = cv2.blur(cv2.blur(plane, (5, 5), borderType=cv2.BORDER_REFLECT), (5, 5), borderType=cv2.BORDER_REFLECT)
    np.testing.assert_allclose(found, mean, atol=1e-6)
