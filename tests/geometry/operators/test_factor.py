"""Factors of symmetric positive definite matrices."""

import numpy as np
import pytest
import scipy.sparse as sp

from toongeo.geometry.operators.factor import factor_spd, solve


def test_it_solves(rng):
    root = rng.normal(size=(30, 30))
    A, X = root @ root.T + np.eye(30), rng.normal(size=(30, 40))  # more right-hand sides than go at once
    np.testing.assert_allclose(solve(factor_spd(sp.csc_matrix(A)), A @ X), X, atol=1e-8)


def test_a_singular_matrix_is_refused():
    with pytest.raises(ValueError, match="V, F: expected a mesh whose equations can be solved"):
        factor_spd(sp.diags([1.0, 0.0, 2.0]).tocsc())
