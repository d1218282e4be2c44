"""The closed form of the eliminated system against gradient operators of libigl."""

import igl
import numpy as np
import pytest
import scipy.sparse as sp

from toongeo.geometry.deformation.transfer_operators import fourth_edges, transfer_operators


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
@pytest.mark.parametrize("by_area", [False, True])
def test_they_are_products_of_gradients(bumpy, by_area, scale):
    source, F = bumpy
    source = scale * source
    target = source * [1.3, 0.8, 1.1] + scale * 0.2 * np.sin(source[:, ::-1] / scale)
    K, B, N = transfer_operators(source, target, np.ascontiguousarray(F.T), by_area=by_area)
    G, H = igl.grad(target, F), igl.grad(source, F)  # (3 m, n): x, y and z of the gradients
    weight = np.tile(igl.doublearea(target, F) if by_area else np.ones(len(F)), 3)
    weighted = G.T @ sp.diags_array(weight)
    size = abs(K).max()
    assert abs(K - weighted @ G).max() < 1e-11 * size
    assert abs(B - weighted @ H).max() < 1e-11 * size
    # The fourth edge's own dual is the normal over its length.
    fourth = fourth_edges(source, F.T)
    dual = fourth / (fourth**2).sum(axis=1, keepdims=True)
    m = np.arange(len(F))
    dual_of = sp.csr_matrix((dual.T.ravel(), (np.arange(3 * len(F)), np.tile(m, 3))), shape=(3 * len(F), len(F)))
    assert abs(N - weighted @ dual_of).max() < 1e-11 * abs(N).max()
