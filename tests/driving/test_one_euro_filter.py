"""The filter is that of Casiez et al., but for speeds within the noise."""

import numpy as np
import pytest

from toongeo.driving.one_euro_filter import OneEuroFilter


def by_the_paper(x, rate, least, beta, speed_cutoff):
    """Algorithm 1 of Casiez et al. 2012 for one signal."""

    def alpha(cutoff):
        tau = 1 / (2 * np.pi * cutoff)
        return 1 / (1 + tau * rate)

    value, speed, out = x[0], 0.0, [x[0]]
    for before, now in zip(x, x[1:], strict=False):
        speed += alpha(speed_cutoff) * ((now - before) * rate - speed)
        value += alpha(least + beta * abs(speed)) * (now - value)
        out.append(value)
    return np.array(out)


def filtered(points, rate=30.0, **options):
    smooth = OneEuroFilter(**options)
    return np.array([smooth(p, i / rate) for i, p in enumerate(points)])


def test_without_thresholds_it_is_the_one_of_the_paper(rng):
    x = np.cumsum(rng.standard_normal(80))
    points = x[:, None, None]
    found = filtered(
        points, noise=2.0, least_cutoff=0.7, speed_cutoff=1.5, alone=(0.0, 0.4), together=(0.0, 0.0), start=points[0]
    )
    np.testing.assert_allclose(found[:, 0, 0], by_the_paper(x, 30.0, 0.7, 0.4 / 2.0, 1.5), atol=1e-12)


def test_scale_of_points_and_noise(rng):
    points = rng.standard_normal((30, 5, 2))
    np.testing.assert_allclose(filtered(1e3 * points, noise=1e3), 1e3 * filtered(points, noise=1.0), rtol=1e-12)


def test_first_samples_are_averaged(rng):
    points = rng.standard_normal((20, 4, 2))
    quiet = filtered(points, noise=10.0, least_cutoff=1e-9)
    means = np.cumsum(points, axis=0) / np.arange(1, 21)[:, None, None]
    np.testing.assert_allclose(quiet, means, atol=1e-7)


def test_motion_goes_through_and_noise_does_not(rng):
    t = np.arange(120) / 30
    path = np.stack([np.sin(3 * t), np.cos(3 * t)], 1)[:, None] * np.ones((10, 1))
    assert np.abs(filtered(path, noise=1e-4) - path).max() < 2e-3
    noise = rng.normal(0, 0.1, (200, 68, 2))
    assert filtered(noise, noise=0.1)[60:].std() < 0.02


def test_a_missing_point_keeps_its_value():
    points = np.tile(np.arange(6.0)[:, None, None], (1, 2, 2))
    points[2:4, 1] = np.nan
    found = filtered(points, noise=1e-6)
    np.testing.assert_array_equal(found[3, 1], found[1, 1])
    assert np.abs(found[5, 1] - 5).max() < 0.1 and np.isfinite(found).all()
    points[0, 0] = np.nan  # not seen before: it begins where it appears
    np.testing.assert_array_equal(filtered(points, noise=1e-6)[1, 0], points[1, 0])


def test_time_that_stands_still_changes_nothing():
    smooth = OneEuroFilter(1.0)
    first = smooth(np.zeros((1, 2)), 1.0)
    np.testing.assert_array_equal(smooth(np.ones((1, 2)), 1.0), first)


@pytest.mark.parametrize("noise", [0.0, -1.0, np.nan])
def test_noise_must_be_positive(noise):
    with pytest.raises(ValueError, match="noise: expected a standard deviation > 0"):
        OneEuroFilter(noise)
