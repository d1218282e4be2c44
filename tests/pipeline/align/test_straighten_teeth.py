import numpy as np

from toongeo.pipeline.align.straighten_teeth import PARTS, STRETCH, straighten_teeth


def test_an_affine_motion_stays_and_a_bent_one_becomes_one(model, rng):
    inside = np.any([model.region(name) for name in PARTS], axis=0)
    moved = model.mean @ (np.eye(3) + 0.1 * rng.normal(size=(3, 3))) + [1, 2, 3]
    np.testing.assert_allclose(straighten_teeth(model, model.mean, moved), moved, atol=1e-9)
    bent = moved + 0.3 * np.sin(model.mean)
    straight = straighten_teeth(model, model.mean, bent)
    np.testing.assert_array_equal(straight[~inside], bent[~inside])
    before = np.column_stack([model.mean[inside], np.ones(inside.sum())])
    affine, *_ = np.linalg.lstsq(before, straight[inside], rcond=None)
    np.testing.assert_allclose(before @ affine, straight[inside], atol=1e-9)


def test_no_axis_is_stretched_much_more_than_another(model):
    inside = np.any([model.region(name) for name in PARTS], axis=0)
    straight = straighten_teeth(model, model.mean, model.mean * [3, 1, 1])
    before, after = (np.ptp(V[inside], axis=0) for V in (model.mean, straight))
    np.testing.assert_allclose(after / before, [STRETCH, 1, 1], rtol=1e-9)
