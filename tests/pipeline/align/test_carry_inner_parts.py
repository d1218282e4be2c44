import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from toongeo.model.anatomy.rims import opening_rim
from toongeo.pipeline.align.carry_inner_parts import carry_inner_parts

INNER = ("mouth_cavity", "teeth_upper", "teeth_lower", "tongue", "socket_left", "socket_right")


def test_a_face_that_did_not_move_stays(model):
    np.testing.assert_allclose(carry_inner_parts(model, model.mean, model.mean.copy()), model.mean, atol=1e-9)


def test_a_rigid_motion_carries_everything(model):
    R = Rotation.from_rotvec([0.02, -0.05, 0.03]).as_matrix()
    moved = model.mean @ R.T + [1, 2, 3]
    skin_only = moved.copy()
    inside = np.any([model.region(name) for name in INNER], axis=0)
    skin_only[inside] = 0
    mouth = np.any([model.region(name) for name in INNER[:4]], axis=0)
    carried = carry_inner_parts(model, model.mean, skin_only)
    np.testing.assert_allclose(carried[mouth], moved[mouth], atol=1e-9)
    np.testing.assert_allclose(carried[~inside], moved[~inside], atol=0)
    assert np.abs(carried - moved).max() < 1.0  # sockets keep their offsets without turning


def test_the_mouth_grows_no_more_than_the_face_that_holds_it(model):
    wide = model.mean.copy()
    rim = opening_rim(model, "mouth_cavity")
    wide[rim] += 0.8 * (wide[rim] - wide[rim].mean(0))
    carried = carry_inner_parts(model, model.mean, wide)
    teeth = model.region("teeth_upper")
    before, after = (np.ptp(V[teeth], axis=0) for V in (model.mean, carried))
    assert (after / before < 1.25).all()


@pytest.mark.parametrize(("side", "growth"), [(0, 2.0), (1, 1.5), (0, 0.7)])
def test_the_socket_of_a_grown_eye_turns_inwards(model, side, growth):
    """Twice as large, half of each offset points to the middle of the eyeball; of a smaller one, none."""
    name = f"socket_{('left', 'right')[side]}"
    rim, inside = opening_rim(model, name), model.region(name)
    middle = model.mean[rim].mean(0)
    moved = model.mean.copy()
    moved[rim] = middle + growth * (moved[rim] - middle)
    found = carry_inner_parts(model, model.mean, moved)[inside]
    nearest = rim[cKDTree(model.mean[rim]).query(model.mean[inside])[1]]
    offset = model.mean[inside] - model.mean[nearest]
    growth = max(growth, 1)
    inward = middle - [0, 0, growth * model.eyes[side].radius] - moved[nearest]
    inward /= np.linalg.norm(inward, axis=1, keepdims=True)
    length = np.linalg.norm(offset, axis=1, keepdims=True)
    expected = moved[nearest] + offset / growth + (1 - 1 / growth) * length * inward
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_the_rims_are_closed_bands_of_skin(model):
    for part in ("socket_left", "socket_right", "mouth_cavity"):
        rim = opening_rim(model, part)
        assert model.region("skin")[rim].all() and not model.region(part)[rim].any() and len(rim) > 30
