import json

import numpy as np
import pytest

from toongeo.io import read_mesh_landmarks, write_mesh_landmarks


@pytest.mark.parametrize("suffix", [".json", ".txt"])
def test_what_is_written_is_read(tmp_path, suffix):
    vertices = [*range(67), None]
    V = np.random.default_rng(0).normal(size=(80, 3))
    write_mesh_landmarks(tmp_path / f"a{suffix}", vertices)
    points = read_mesh_landmarks(tmp_path / f"a{suffix}", V)
    np.testing.assert_array_equal(points[:67], V[:67])
    assert np.isnan(points[67]).all()


def test_json_is_a_plain_list(tmp_path):
    """As `MorphableModel.with_landmarks` takes it."""
    write_mesh_landmarks(tmp_path / "a.json", np.arange(68))
    assert json.loads((tmp_path / "a.json").read_text()) == list(range(68))


@pytest.mark.parametrize(
    ("vertices", "text"),
    [
        ([1] * 67, "vertices: expected 68, got 67"),
        ([None] * 68, "all are missing"),
        ([-1] * 68, "got -1 for landmark 0"),
        ([1.5] * 68, "got 1.5"),
        ([True] * 68, "got True"),
    ],
)
def test_what_is_no_table(tmp_path, vertices, text):
    with pytest.raises(ValueError, match=text):
        write_mesh_landmarks(tmp_path / "a.json", vertices)
    with pytest.raises(ValueError, match=r"path: expected .json or .txt"):
        write_mesh_landmarks(tmp_path / "a.pts", [1] * 68)
    assert not list(tmp_path.iterdir())
