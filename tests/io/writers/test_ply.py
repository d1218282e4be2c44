"""PLY, read by trimesh."""

import numpy as np
import pytest
import trimesh

from toongeo.io import write_ply


@pytest.mark.parametrize("colored", [False, True])
def test_trimesh_reads_it(tmp_path, rng, colored):
    V, F = rng.standard_normal((50, 3)), rng.permuted(np.arange(50)[:48]).reshape(-1, 3)
    colors = rng.integers(0, 256, (50, 3), dtype=np.uint8) if colored else None
    write_ply(tmp_path / "ü.ply", V, F, colors)
    loaded = trimesh.load(tmp_path / "ü.ply", process=False, force="mesh")
    np.testing.assert_array_equal(loaded.vertices, V.astype(np.float32))
    np.testing.assert_array_equal(loaded.faces, F)
    if colored:
        np.testing.assert_array_equal(loaded.visual.vertex_colors[:, :3], colors)


@pytest.mark.parametrize(
    ("V", "F", "colors", "message"),
    [
        (np.zeros((3, 2)), [[0, 1, 2]], None, r"V: expected finite \(n, 3\), got shape \(3, 2\)"),
        (np.full((3, 3), np.nan), [[0, 1, 2]], None, "V: expected finite"),
        (np.eye(3), [[0.0, 1, 2]], None, r"F: expected \(m, 3\) integers, got float64"),
        (np.eye(3), [[0, 1, 3]], None, "F: expected indices in 0..2, got 0..3"),
        (np.eye(3), [[0, 1, -1]], None, "got -1..1"),
        (np.eye(3), [[0, 1, 2]], np.eye(3), r"colors: expected uint8 \(3, 3\), got float64"),
    ],
)
def test_refused(tmp_path, V, F, colors, message):
    with pytest.raises(ValueError, match=message):
        write_ply(tmp_path / "a.ply", V, F, colors)
    assert list(tmp_path.iterdir()) == []


def test_place(tmp_path):
    with pytest.raises(OSError, match=r"cannot write .*none/a\.ply"):
        write_ply(tmp_path / "none" / "a.ply", np.eye(3), [[0, 1, 2]])
