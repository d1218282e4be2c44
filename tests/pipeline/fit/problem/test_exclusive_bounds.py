"""At most one of two opposite expressions, whichever way round."""

import numpy as np
import pytest

from toongeo.model.opposites import OPPOSITES, opposite_expressions
from toongeo.pipeline.fit.problem.exclusive_bounds import exclusive_bounds

PAIRS = np.array([[0, 1], [3, 2]])


@pytest.mark.parametrize(
    ("x", "held"),
    [
        ([0.2, 0.5, 0.1, 0.0], [True, False, False, False]),
        ([0.5, 0.2, 0.1, 0.3], [False, True, True, False]),
        ([0.4, 0.4, 0.0, 0.0], [True, True, False, False]),
        ([0.0, 0.0, 0.0, 0.0], [False, False, False, False]),
    ],
)
def test_the_lesser_is_held(x, held):
    upper = np.array([1.0, 2.0, 3.0, 4.0])
    expected = np.where(held, 0, upper)
    np.testing.assert_array_equal(exclusive_bounds(upper, np.array(x), PAIRS), expected)
    np.testing.assert_array_equal(exclusive_bounds(upper, np.array(x), PAIRS[:, ::-1]), expected)
    np.testing.assert_array_equal(upper, [1, 2, 3, 4])


def test_the_table_names_expressions_of_the_template_and_knows_no_side(model):
    pairs = opposite_expressions(model)
    assert len(pairs) == len(OPPOSITES)
    flip = {"Left": "Right", "Right": "Left"}

    def mirrored(name):
        return next((name.removesuffix(side) + other for side, other in flip.items() if name.endswith(side)), name)

    known = {frozenset(pair) for pair in OPPOSITES}
    assert {frozenset(map(mirrored, pair)) for pair in known} == known


def test_opposite_expressions_move_the_face_opposite_ways(model):
    for i, j in opposite_expressions(model):
        a, b = (model.expression[k].ravel().astype(float) for k in (i, j))
        assert a @ b < -0.3 * np.linalg.norm(a) * np.linalg.norm(b)
