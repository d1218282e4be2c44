import numpy as np

from toongeo.pipeline.align.noise.left_out import left_out

K = 9


def test_it_is_what_leaving_each_out_gives(rng):
    A = rng.normal(size=(2 * K, 2 * K))
    C, y = A @ A.T + np.eye(2 * K), rng.normal(size=(K, 2))
    missed, z = left_out(C, y)
    for i in range(K):
        own, rest = np.arange(2 * i, 2 * i + 2), np.r_[0 : 2 * i, 2 * i + 2 : 2 * K]
        toward = C[np.ix_(own, rest)] @ np.linalg.inv(C[np.ix_(rest, rest)])
        error = y[i] - toward @ y.ravel()[rest]
        spread = C[np.ix_(own, own)] - toward @ C[np.ix_(rest, own)]
        np.testing.assert_allclose(missed[i], error, atol=1e-9)
        np.testing.assert_allclose(z[i], np.sqrt(error @ np.linalg.solve(spread, error)), rtol=1e-9)


def test_without_a_field_only_the_point_itself_counts(rng):
    y = rng.normal(size=(K, 2))
    missed, z = left_out(0.25 * np.eye(2 * K), y)
    np.testing.assert_allclose(missed, y)
    np.testing.assert_allclose(z, np.linalg.norm(y, axis=1) / 0.5)
