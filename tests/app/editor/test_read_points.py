"""Points of a message."""

import numpy as np
import pytest

from toongeo.app.editor.read_points import read_points


def test_points_and_gaps():
    points = read_points([[k, -0.5] for k in range(67)] + [None])
    np.testing.assert_array_equal(points[:67], np.column_stack([np.arange(67), np.full(67, -0.5)]))
    assert np.isnan(points[67]).all()


@pytest.mark.parametrize(
    ("value", "error"),
    [
        (None, "points: expected a list of 68 points, got None"),
        ([[0, 0]] * 67, "points: expected a list of 68 points, got 67 entries"),
        ("x" * 68, "points: expected a list of 68 points, got xxx"),
        ([[0, 0]] * 67 + [[1]], r"points: expected \[x, y\] in px or null, got \[1\] for point 67"),
        ([[0, 0]] * 67 + [[1, "2"]], "for point 67"),
        ([[True, 0]] + [[0, 0]] * 67, "for point 0"),
        ([[float("nan"), 0]] + [[0, 0]] * 67, "for point 0"),
        ([[1e7, 0]] + [[0, 0]] * 67, "for point 0"),
        ([[10**400, 0]] + [[0, 0]] * 67, "for point 0"),
    ],
)
def test_what_is_none(value, error):
    with pytest.raises(ValueError, match=error):
        read_points(value)
