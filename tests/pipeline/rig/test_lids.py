import numpy as np
import pytest

from toongeo.pipeline import align_face, build_rig, clear_lids, close_lids, fit_3dmm, fit_eyes
from toongeo.pipeline.align.rim_anchors import rim_path
from toongeo.pipeline.rig.clear_lids import _outward


@pytest.fixture(scope="module", params=["manga_girl", "astronaut"])
def stages(request, cartoon):
    img, landmarks = cartoon(request.param)
    face = align_face(fit_3dmm(img, landmarks), landmarks)
    transferred = build_rig(face)
    rig = close_lids(face, transferred)
    eyes = fit_eyes(face, rig)
    return face, transferred, eyes, clear_lids(face, rig, eyes)


def opening(V, model, side):
    """Largest distance, mm, from the upper rim of an eye to the curve of the lower one."""
    upper, lower = (V[rim_path(model, f"lid_{lid}_{side}")] for lid in ("upper", "lower"))
    steps = np.linspace(0, 1, 20)[:, None, None]
    curve = (lower[:-1] + steps * (lower[1:] - lower[:-1])).reshape(-1, 3)
    return np.linalg.norm(upper[:, None] - curve, axis=2).min(1).max()


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_blink_closes_the_eye_however_large(stages, side):
    face, before, _, after = stages
    blink = {f"eyeBlink{side.capitalize()}": 1.0}
    closed, transferred, neutral = (
        opening(V, face.model, side) for V in (after.vertices(blink), before.vertices(blink), before.neutral)
    )
    assert closed < 0.06 * neutral
    assert closed <= transferred


def test_only_the_surroundings_of_the_eyes_change(stages):
    face, before, _, after = stages
    near = np.any([face.region(n) for n in ("eye_left", "eye_right", "socket_left", "socket_right")], axis=0)
    np.testing.assert_array_equal(after.deltas[:, ~near], before.deltas[:, ~near])
    np.testing.assert_array_equal(after.neutral, before.neutral)


def test_no_skin_is_inside_an_eyeball_in_any_expression(stages):
    face, _, eyes, rig = stages
    for side in (0, 1):
        lids = face.region("skin")
        for delta in (np.zeros_like(rig.deltas[0]), *rig.deltas):
            offset = (rig.neutral + delta)[lids] - eyes.centres[side]
            ahead = offset[:, 2] > 0
            assert np.linalg.norm(offset[ahead], axis=1).min() >= eyes.radii[side]


@pytest.mark.parametrize("weight", [0.25, 0.5, 0.75, 1.0])
def test_no_lid_is_inside_an_eyeball_while_it_closes(stages, weight):
    face, _, eyes, rig = stages
    for side, name in enumerate(("left", "right")):
        lids = face.region(f"eyelid_upper_{name}") | face.region(f"eyelid_lower_{name}")
        offset = rig.vertices({f"eyeBlink{name.capitalize()}": weight})[lids] - eyes.centres[side]
        assert np.linalg.norm(offset[offset[:, 2] > 0], axis=1).min() >= eyes.radii[side]


def test_outward_moves_to_the_surface_and_no_further(rng):
    offsets = rng.normal(size=(200, 3)) * 8
    moved = offsets + _outward(offsets, 10.0)
    inside = (np.linalg.norm(offsets, axis=1) < 10) & (offsets[:, 2] > 0)
    np.testing.assert_allclose(np.linalg.norm(moved[inside], axis=1), 10.0, rtol=1e-12)
    np.testing.assert_array_equal(moved[~inside], offsets[~inside])
