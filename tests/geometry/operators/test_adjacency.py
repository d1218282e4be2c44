"""The vertex graph, edge by edge."""

import numpy as np
import pytest

from toongeo.geometry.operators.adjacency import adjacency


def edge_by_edge(F, n):
    A = np.zeros((n, n))
    for triangle in F:
        for i in triangle:
            A[i, [j for j in triangle if j != i]] = 1
    return A


def test_every_edge_is_one_once(bumpy):
    V, F = bumpy
    A = adjacency(F, len(V))
    assert A.dtype == np.float64 and A.has_canonical_format
    np.testing.assert_array_equal(A.toarray(), edge_by_edge(F, len(V)))


@pytest.mark.parametrize(
    "F",
    [[[0, 1, 2], [0, 2, 1]], [[0, 1, 2], [1, 1, 3]], [[2, 2, 2]], [[3, 0, 1]]],
    ids=["both sides", "a corner twice", "one point", "unused vertices"],
)
@pytest.mark.parametrize("n", [4, 9])
def test_odd_triangles_and_vertices_in_none(F, n):
    A = adjacency(np.array(F), n)
    np.testing.assert_array_equal(A.toarray(), edge_by_edge(F, n))
    assert A.nnz == edge_by_edge(F, n).sum()  # no zeros are stored
