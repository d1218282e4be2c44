import numpy as np
import pytest

from toongeo.model.anatomy.rims import rim_path
from toongeo.model.anatomy.straighten_teeth import PARTS, PARTS_OF_RIM, STRETCH, straighten_teeth


def test_an_affine_motion_stays_and_a_bent_one_becomes_one(model, rng):
    inside = np.any([model.region(name) for name in PARTS], axis=0)
    moved = model.mean @ (np.eye(3) + 0.1 * rng.normal(size=(3, 3))) + [1, 2, 3]
    np.testing.assert_allclose(straighten_teeth(model, model.mean, moved), moved, atol=1e-9)
    bent = moved + 0.3 * np.sin(model.mean)
    straight = straighten_teeth(model, model.mean, bent)
    np.testing.assert_array_equal(straight[~inside], bent[~inside])
    linear = []
    for parts in PARTS_OF_RIM.values():
        row = np.any([model.region(name) for name in parts], axis=0)
        before = np.column_stack([model.mean[row], np.ones(row.sum())])
        affine, *_ = np.linalg.lstsq(before, straight[row], rcond=None)
        np.testing.assert_allclose(before @ affine, straight[row], atol=1e-9)
        linear.append(affine[:3])
    np.testing.assert_allclose(*linear, atol=1e-9)


def test_no_axis_is_stretched_much_more_than_another(model):
    inside = np.any([model.region(name) for name in PARTS], axis=0)
    straight = straighten_teeth(model, model.mean, model.mean * [3, 1, 1])
    before, after = (np.ptp(V[inside], axis=0) for V in (model.mean, straight))
    np.testing.assert_allclose(after / before, [STRETCH, 1, 1], rtol=1e-9)


@pytest.mark.parametrize(("rim", "parts"), PARTS_OF_RIM.items())
def test_a_row_keeps_its_place_behind_its_lip(model, rim, parts):
    """Wherever the flow took it: the inside of the head is shifted, and lips part from each other."""
    inside = np.any([model.region(name) for name in PARTS], axis=0)
    lips = {name: rim_path(model, name) for name in PARTS_OF_RIM}
    after = model.mean + np.where(inside[:, None], [0, 25.0, -5], 0)
    after[np.setdiff1d(lips["lip_lower_inner"], lips["lip_upper_inner"])] -= [0, 9.0, 0]
    straight = straighten_teeth(model, model.mean, after)
    row = np.any([model.region(name) for name in parts], axis=0)
    moved = straight[row] - model.mean[row]
    np.testing.assert_allclose(moved, (after - model.mean)[lips[rim]].mean(0) + 0 * moved, atol=1e-9)
