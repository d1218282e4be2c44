import numpy as np
import pytest

from toongeo.render import linear_to_srgb, srgb_to_linear


def test_round_trip():
    values = np.linspace(-0.2, 1.5, 2001)
    np.testing.assert_allclose(linear_to_srgb(srgb_to_linear(values)), values, atol=1e-7)
    np.testing.assert_allclose(srgb_to_linear(linear_to_srgb(values)), values, atol=1e-7)
    every = np.arange(256, dtype=np.uint8)
    assert (np.round(linear_to_srgb(srgb_to_linear(every)) * 255) == every).all()


@pytest.mark.parametrize(("srgb", "linear"), [(0, 0), (1, 1), (0.04045, 0.04045 / 12.92), (0.5, 0.21404114)])
def test_values_of_the_standard(srgb, linear):
    assert srgb_to_linear(np.float64(srgb)) == pytest.approx(linear, abs=1e-8)


def test_increasing_and_without_a_step():
    values = np.linspace(0.0, 1.0, 100001)
    slopes = np.diff(srgb_to_linear(values)) / np.diff(values)
    assert slopes.min() > 0.0
    assert abs(np.diff(srgb_to_linear(np.array([0.04045, np.nextafter(0.04045, 1)])))[0]) < 1e-7


def test_types():
    assert srgb_to_linear(np.zeros((2, 3), np.uint8)).dtype == np.float32
    assert srgb_to_linear(np.zeros(2, np.float32)).dtype == np.float32
    assert linear_to_srgb(np.zeros(2, np.float32)).dtype == np.float32
    assert linear_to_srgb([0, 1]).dtype == np.float64
    np.testing.assert_allclose(srgb_to_linear(np.uint8([10, 200])), srgb_to_linear([10 / 255, 200 / 255]), rtol=1e-6)
