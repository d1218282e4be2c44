import numpy as np
import pytest

from toongeo.render import sample_image, uv_to_px


def grid_px(height, width):
    y, x = np.mgrid[:height, :width]
    return np.column_stack([x.ravel(), y.ravel()])


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32, np.float64])
@pytest.mark.parametrize("shape", [(5, 7), (5, 7, 3), (1, 7, 1), (5, 1)])
def test_exact_at_pixel_centres(shape, dtype):
    img = np.random.default_rng(0).integers(0, 250, shape).astype(dtype)
    values = sample_image(img, grid_px(*shape[:2]))
    assert (values == img.reshape(-1, *shape[2:])).all()
    assert values.dtype == (np.float64 if dtype is np.float64 else np.float32)


def test_bilinear_functions_are_exact():
    y, x = np.mgrid[:9, :12].astype(float)
    px = np.random.default_rng(1).uniform(0, [11, 8], (200, 2))
    u, v = px.T
    expected = 3.0 * u - 2.0 * v + 0.5 * u * v + 1.0
    np.testing.assert_allclose(sample_image(3 * x - 2 * y + 0.5 * x * y + 1, px), expected, rtol=1e-12)


def test_outside_counts_the_border():
    img = np.random.default_rng(2).random((6, 8, 2))
    px = np.random.default_rng(3).uniform(-20, 30, (300, 2))
    inside = np.clip(px, 0, [7, 5])
    assert (sample_image(img, px) == sample_image(img, inside)).all()
    assert (sample_image(img, [[1e30, -1e30]])[0] == img[0, -1]).all()


def test_values_stay_within_the_image():
    img = np.random.default_rng(4).integers(0, 255, (6, 8), dtype=np.uint8)
    values = sample_image(img, np.random.default_rng(5).uniform(-1, 9, (500, 2)))
    assert values.min() >= img.min() and values.max() <= img.max()


def test_shift_equivariance():
    img = np.random.default_rng(6).random((20, 20))
    px = np.random.default_rng(7).uniform(0, 14, (100, 2))
    shifted = px + np.array([5.0, 3.0])
    np.testing.assert_allclose(sample_image(img[3:, 5:], px), sample_image(img, shifted), rtol=1e-12)


def test_no_samples():
    assert sample_image(np.zeros((4, 4, 3)), np.zeros((0, 2))).shape == (0, 3)


def test_bad_input():
    with pytest.raises(ValueError, match="img: expected shape"):
        sample_image(np.zeros(4), [[0, 0]])
    with pytest.raises(ValueError, match="img: expected shape"):
        sample_image(np.zeros((0, 4)), [[0, 0]])
    with pytest.raises(ValueError, match=r"px: expected shape \(k, 2\)"):
        sample_image(np.zeros((4, 4)), [0, 0])
    with pytest.raises(ValueError, match="px: expected finite"):
        sample_image(np.zeros((4, 4)), [[0, np.nan]])


def test_uv_to_px_follows_the_texel_centres():
    row, column = np.mgrid[:4, :6]
    uv = np.column_stack([(column.ravel() + 0.5) / 6, 1.0 - (row.ravel() + 0.5) / 4])
    np.testing.assert_allclose(uv_to_px(uv, 4, 6), np.column_stack([column.ravel(), row.ravel()]), atol=1e-12)
    with pytest.raises(ValueError, match=r"uv: expected shape \(t, 2\)"):
        uv_to_px(np.zeros((4, 3)), 4, 6)
