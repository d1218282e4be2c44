import numpy as np
import pytest

from toongeo.model.anatomy.rim_anchors import rim_anchors
from toongeo.model.anatomy.rims import rim_path
from toongeo.model.ibug68 import LID_RIMS, LIP_RIMS


@pytest.mark.parametrize(("name", "rim"), [*LID_RIMS.items(), *LIP_RIMS.items()])
def test_a_rim_is_a_path_of_edges_through_its_landmarks(model, name, rim):
    path = rim_path(model, name)
    edges = {frozenset(edge) for face in model.faces for edge in zip(face, np.roll(face, 1), strict=True)}
    assert all(frozenset(edge) in edges for edge in zip(path[:-1], path[1:], strict=True))
    places = [list(path).index(vertex) for vertex in model.landmarks[list(rim)]]
    assert places == sorted(places) and places[0] == 0 and places[-1] == len(path) - 1
    assert len(set(path)) == len(path)


def test_a_shift_of_all_landmarks_shifts_the_rims(model):
    vertices, shift = rim_anchors(model, np.tile([3.0, -2.0], (68, 1)))
    np.testing.assert_allclose(shift, np.tile([3.0, -2.0], (len(vertices), 1)), atol=1e-12)
    assert len(np.unique(vertices)) == len(vertices) > 60
    assert not np.isin(vertices, model.landmarks).any()


def test_lips_take_displacements_between_those_of_their_landmarks(model, rng):
    displacement = rng.normal(size=(68, 1))
    vertices, moved = rim_anchors(model, displacement)
    upper = np.isin(vertices, rim_path(model, "lip_upper_inner"))
    bounds = displacement[list(LIP_RIMS["lip_upper_inner"])]
    assert (moved[upper] >= bounds.min() - 1e-12).all() and (moved[upper] <= bounds.max() + 1e-12).all()


def test_missing_landmarks_leave_their_neighbourhood_free(model):
    displacement = np.zeros((68, 2))
    everything, _ = rim_anchors(model, displacement)
    displacement[36] = np.nan
    fewer, moved = rim_anchors(model, displacement)
    np.testing.assert_array_equal(moved, 0)
    gone = set(everything) - set(fewer)
    upper, lower = (rim_path(model, f"lid_{lid}_right").tolist() for lid in ("upper", "lower"))
    beside = upper[: upper.index(model.landmarks[37])] + lower[: lower.index(model.landmarks[41])]
    assert gone == set(beside) - set(model.landmarks)
    assert len(rim_anchors(model, np.full((68, 2), np.nan))[0]) == 0
