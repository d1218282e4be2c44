"""Landmarks of a mesh as JSON."""

import json

import numpy as np
import pytest

from toongeo.io import read_mesh_landmarks

V = np.arange(300.0).reshape(100, 3)


def write(path, content):
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path


def test_vertices_points_and_missing_ones(tmp_path):
    entries = [3, [1.5, 2, -3], None, *range(65)]
    expected = np.vstack([V[3], [1.5, 2, -3], [np.nan] * 3, V[:65]])
    for content in (entries, {"landmarks": entries, "author": "someone"}):
        found = read_mesh_landmarks(write(tmp_path / "a.json", content), V)
        np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("{", "path: expected JSON"),
        ("\ufeff?", "path: expected JSON"),
        (list(range(67)), "path: expected a list of 68 entries .* got 67 entries"),
        ({"points": []}, "path: expected a list of 68 entries .* got NoneType"),
        (5, "path: expected a list of 68 entries .* got int"),
        ([100] * 68, r"landmark 0 in .*: expected a vertex in 0\.\.99, got 100"),
        ([0] * 67 + [-1], r"landmark 67 in .*: expected a vertex in 0\.\.99, got -1"),
        ([[1, 2]] * 68, r"landmark 0 in .*: expected a vertex, \[x, y, z\] or null, got \[1, 2\]"),
        ([[1, 2, "3"]] * 68, "landmark 0 in .*: expected a vertex"),
        ('[' + '[1, 2, NaN], ' * 67 + '0]', "landmark 0 in .*: expected a vertex"),
        ([True] * 68, "landmark 0 in .*: expected a vertex"),
        ([1.5] * 68, "landmark 0 in .*: expected a vertex"),
    ],
)  # fmt: skip
def test_other_forms_are_refused(tmp_path, content, message):
    with pytest.raises(ValueError, match=message):
        read_mesh_landmarks(write(tmp_path / "a.json", content), V)


def test_a_missing_file_is_an_os_error(tmp_path):
    with pytest.raises(OSError, match="none"):
        read_mesh_landmarks(tmp_path / "none.json", V)
