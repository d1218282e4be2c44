import numpy as np
import pytest
from scipy.stats import multivariate_normal

from toongeo.pipeline.align.noise.field_likelihood import FieldLikelihood

N = 40


@pytest.fixture
def covariance(rng):
    x = np.sort(rng.uniform(0, 5, N))
    return np.exp(-np.abs(x[:, None] - x))


def sample(rng, covariance, amplitude, sigma):
    return amplitude * np.linalg.cholesky(covariance) @ rng.normal(size=N) + sigma * rng.normal(size=N)


def test_it_is_the_density_of_a_gaussian(rng, covariance):
    y = rng.normal(size=N)
    likelihood = FieldLikelihood.of(covariance, y)
    for amplitude, sigma in ((0.3, 0.1), (2.0, 0.5)):
        density = multivariate_normal(np.zeros(N), amplitude**2 * covariance + sigma**2 * np.eye(N)).logpdf(y)
        value, _ = likelihood.value_and_gradient(amplitude, sigma)
        assert value + N / 2 * np.log(2 * np.pi) == pytest.approx(-density, rel=1e-10)


@pytest.mark.parametrize("by", [(1.0, 0.0), (0.0, 1.0), (0.6, -0.8)])
def test_what_the_gradient_leaves_falls_by_the_square(rng, covariance, by):
    likelihood = FieldLikelihood.of(covariance, rng.normal(size=N))
    value, gradient = likelihood.value_and_gradient(0.5, 0.2)
    steps = np.geomspace(1e-4, 1e-1, 7)
    left = [
        abs(
            likelihood.value_and_gradient(0.5 * np.exp(h * by[0]), 0.2 * np.exp(h * by[1]))[0]
            - value
            - h * gradient @ by
        )
        for h in steps
    ]
    slope = np.polyfit(np.log(steps), np.log(left), 1)[0]
    assert slope == pytest.approx(2, abs=0.1)


def test_no_other_pair_is_more_likely(rng, covariance):
    likelihood = FieldLikelihood.of(covariance, sample(rng, covariance, 0.4, 0.05))
    amplitude, sigma = likelihood.most_likely()
    best, gradient = likelihood.value_and_gradient(amplitude, sigma)
    np.testing.assert_allclose(gradient, 0, atol=1e-6)
    for a in amplitude * np.geomspace(0.3, 3, 15):
        for s in sigma * np.geomspace(0.3, 3, 15):
            assert likelihood.value_and_gradient(a, s)[0] >= best - 1e-9


@pytest.mark.parametrize(("amplitude", "sigma"), [(0.2, 0.02), (0.2, 0.1), (1.5, 0.3)])
def test_what_made_the_samples_is_found(covariance, amplitude, sigma):
    """The median of many, for each has an error of its own."""
    rng = np.random.default_rng(3)
    many = [FieldLikelihood.of(covariance, sample(rng, covariance, amplitude, sigma)).most_likely() for _ in range(60)]
    np.testing.assert_allclose(np.median(many, 0), [amplitude, sigma], rtol=0.2)


def test_twice_the_motion_has_twice_the_field_and_noise(rng, covariance):
    y = sample(rng, covariance, 0.3, 0.05)
    once, twice = (FieldLikelihood.of(covariance, c * y).most_likely() for c in (1, 2))
    np.testing.assert_allclose(twice, 2 * np.array(once), rtol=1e-6)


@pytest.mark.parametrize(("sigma", "ratio"), [(0.0, 0.005), (5.0, 0.7)])
def test_the_ratio_is_bounded(rng, covariance, sigma, ratio):
    y = 100 * covariance[:, 7] if sigma == 0 else sigma * rng.normal(size=N)
    amplitude, found = FieldLikelihood.of(covariance, y).most_likely()
    assert found / amplitude == pytest.approx(ratio)


def test_without_motion_there_is_no_noise(covariance):
    assert FieldLikelihood.of(covariance, np.zeros(N)).most_likely() == (0.0, 0.0)


def test_for_a_known_noise_the_amplitude_is_the_likeliest(rng, covariance):
    likelihood = FieldLikelihood.of(covariance, sample(rng, covariance, 0.4, 0.05))
    amplitude = likelihood.amplitude_for(0.08)
    assert likelihood.value_and_gradient(amplitude, 0.08)[1][0] == pytest.approx(0, abs=1e-6)
    around = [likelihood.value_and_gradient(amplitude * f, 0.08)[0] for f in (0.5, 0.9, 1, 1.1, 2)]
    assert int(np.argmin(around)) == 2
