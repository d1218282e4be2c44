"""What a mesh of hair must be."""

import dataclasses

import numpy as np
import pytest

from toongeo.pipeline import Hair


@pytest.fixture
def tetrahedron():
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    return Hair(V, faces, V[:, :2].copy(), faces, np.zeros((2, 2, 3), np.uint8))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"vertices": np.zeros((4, 2))}, r"vertices: expected finite numbers \(n, 3\), got shape \(4, 2\)"),
        ({"vertices": np.zeros(4)}, r"vertices: expected finite numbers \(n, 3\), got shape \(4,\)"),
        ({"vertices": np.full((4, 3), np.nan)}, r"vertices: expected finite numbers"),
        ({"uv": np.zeros((4, 3))}, r"uv: expected finite numbers \(n, 2\)"),
        ({"vertices": np.zeros((3, 3))}, r"faces: expected indices \(4, 3\) below 3"),
        ({"faces": -np.ones((4, 3), int)}, r"faces: expected indices \(4, 3\) below 4"),
        ({"faces": np.zeros((4, 4), int)}, r"faces: expected indices \(4, 3\) below 4, got \(4, 4\)"),
        ({"uv": np.zeros((3, 2))}, r"uv_faces: expected indices \(4, 3\) below 3"),
        ({"uv_faces": np.zeros((3, 3), int)}, r"uv_faces: expected indices \(4, 3\) below 4, got \(3, 3\)"),
        ({"texture": np.zeros((2, 2), np.uint8)}, r"texture: expected \(H, W, 3\) uint8, got uint8 \(2, 2\)"),
        ({"texture": np.zeros((2, 2, 4), np.uint8)}, r"texture: expected \(H, W, 3\) uint8"),
        ({"texture": np.zeros((2, 2, 3))}, r"texture: expected \(H, W, 3\) uint8, got float64"),
    ],
)
def test_what_is_none_is_named(tetrahedron, change, message):
    with pytest.raises(ValueError, match=message):
        dataclasses.replace(tetrahedron, **change)


def test_a_mesh_of_nothing_is_allowed():
    none = np.zeros((0, 3), int)
    assert len(Hair(np.zeros((0, 3)), none, np.zeros((0, 2)), none, np.zeros((1, 1, 3), np.uint8)).faces) == 0


def test_the_first_and_the_last_vertex_may_be_used(tetrahedron):
    assert tetrahedron.faces.min() == 0 and tetrahedron.faces.max() == len(tetrahedron.vertices) - 1
