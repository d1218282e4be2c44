"""Connected components."""

import numpy as np
import pytest

from toongeo.geometry.operators.vertex_components import vertex_components


def test_parts_and_lonely_vertices(two_parts):
    V, F = two_parts
    half = (len(V) - 1) // 2
    expected = np.repeat([0, 1, 2], [half, half, 1])
    np.testing.assert_array_equal(vertex_components(F[::-1], len(V)), expected)


def test_touching_in_one_vertex_is_connected():
    np.testing.assert_array_equal(vertex_components([[0, 1, 2], [2, 3, 4]], 5), np.zeros(5))


def test_bad_faces():
    with pytest.raises(ValueError, match=r"F: expected indices in 0\.\.1"):
        vertex_components([[0, 1, 2]], 2)
