import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo.model.anatomy.straighten_teeth import PARTS
from toongeo.pipeline import align_face
from toongeo.pipeline.align.keep_teeth_inside import STEP, STEPS, enclosed, keep_teeth_inside


@pytest.fixture(scope="module")
def held(model):
    return np.any([model.region(name) for name in PARTS], axis=0)


def test_the_skin_encloses_what_is_behind_it(model):
    lips, nose = model.mean[model.region("lips")].mean(0), model.mean[model.region("nose")].mean(0)
    points = np.array([lips - [0, 0, 30], lips + [0, 0, 20], nose - [0, 0, 20], nose + [0, 0, 40], [0, 0, -80.0]])
    np.testing.assert_array_equal(enclosed(model, model.mean, points), [True, False, True, False, True])


def test_the_template_keeps_its_teeth(model):
    np.testing.assert_array_equal(keep_teeth_inside(model, model.mean), model.mean)


@pytest.mark.parametrize("wrong", ["forward", "wide"])
def test_teeth_that_stick_out_shrink_until_the_skin_encloses_them(model, held, wrong):
    V = model.mean.copy()
    V[held] = V[held] + [0, 0, 12.0] if wrong == "forward" else V[held] * [2.0, 1, 1]
    assert not enclosed(model, V, V[held]).all()
    kept = keep_teeth_inside(model, V)
    assert enclosed(model, kept, kept[held]).all()
    np.testing.assert_array_equal(kept[~held], V[~held])
    np.testing.assert_array_equal(kept[held][:, 1], V[held][:, 1])
    sizes = np.ptp(kept[held], axis=0)[[0, 2]] / np.ptp(V[held], axis=0)[[0, 2]]
    assert sizes[0] == pytest.approx(sizes[1], rel=1e-9)  # all parts alike, width and length alike
    assert STEP ** (STEPS - 1) <= sizes[0] < 1


def test_moving_the_head_moves_the_teeth(model, held):
    V = model.mean + np.where(held[:, None], [0, 0, 12.0], 0)
    shift = np.array([100.0, -50, 30])
    np.testing.assert_allclose(keep_teeth_inside(model, V + shift), keep_teeth_inside(model, V) + shift, atol=1e-9)


@pytest.mark.parametrize("name", CARTOONS)
@pytest.mark.parametrize("flow", [True, False])
def test_no_tooth_is_outside_of_a_drawn_face(name, flow, model, held, cartoon, fits, aligned):
    face = aligned(name) if flow else align_face(fits(name), cartoon(name)[1], flow=False)
    V = face.vertices
    assert enclosed(model, V, V[held]).all()
