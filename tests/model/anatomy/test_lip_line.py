import numpy as np
import pytest

from toongeo.geometry import adjacency
from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model.anatomy.lip_line import lip_line


@pytest.fixture(scope="module")
def line(model):
    return lip_line(model)


def test_both_paths_go_along_edges_from_the_right_corner_to_the_left_one(model, line):
    A = adjacency(model.faces, len(model.mean))
    for path in (line.upper, line.lower):
        assert all(A[a, b] for a, b in zip(path[:-1], path[1:], strict=True))
        assert len(np.unique(path)) == len(path)
    np.testing.assert_array_equal(line.upper[[0, -1]], line.lower[[0, -1]])
    assert model.mean[line.upper[0], 0] < model.mean[line.upper[-1], 0]


def test_the_line_is_where_skin_meets_the_inside_of_the_mouth(model, line):
    inside = model.region("mouth_cavity")
    np.testing.assert_array_equal(np.sort(model.mirror[line.vertices]), np.sort(line.vertices))
    assert not inside[line.vertices].any()
    A = adjacency(model.faces, len(model.mean)).tocsr()
    assert ((A[line.vertices] @ inside.astype(float)) > 0).all()


def test_the_upper_lip_is_above(model, line):
    middle = len(line.upper) // 2, len(line.lower) // 2
    assert model.mean[line.upper[middle[0]], 1] > model.mean[line.lower[middle[1]], 1]
    for red, column, path in (
        (line.upper_red, line.upper_column, line.upper),
        (line.lower_red, line.lower_column, line.lower),
    ):
        assert not np.isin(red, line.vertices).any()
        distances = np.linalg.norm(model.mean[red][:, None] - model.mean[path], axis=2)
        np.testing.assert_allclose(distances[np.arange(len(red)), column], distances.min(1))


def test_the_line_moves_as_told_and_the_far_face_stays(model, line, rng):
    shift = rng.normal(size=(len(line.vertices), 3))
    moved = np.zeros_like(model.mean)
    moved[line.follows] = line.spread @ shift
    np.testing.assert_allclose(moved[line.vertices], shift, atol=1e-12)
    assert not moved[model.region("nose") | model.region("forehead") | model.region("neck")].any()


def test_the_spread_of_a_symmetric_shift_is_symmetric(model, line):
    moved = np.zeros(len(model.mean))
    on_line = model.mean[line.vertices]
    moved[line.follows] = line.spread @ (on_line[:, 1] + on_line[:, 0] ** 2)
    np.testing.assert_allclose(moved[model.mirror], moved, atol=1e-6 * np.abs(moved).max())


def test_lengths_along_a_path_are_shares_of_the_whole():
    path = np.array([[0.0, 0, 0], [3, 0, 0], [3, 1, 0]])
    np.testing.assert_allclose(arc_shares(path), [0, 0.75, 1])
    np.testing.assert_allclose(interpolated(np.array([0.5, 0.875]), arc_shares(path), path), [[2, 0, 0], [3, 0.5, 0]])
