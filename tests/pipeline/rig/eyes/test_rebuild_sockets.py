import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo.model.anatomy.parts import SIDES
from toongeo.model.anatomy.rims import opening_rim
from toongeo.pipeline import close_lids, fit_eyes, keep_lids_outside
from toongeo.pipeline.rig.eyes.rebuild_sockets import DEPTH, _band, _lined, rebuild_sockets
from toongeo.pipeline.rig.eyes.seat_lids import seat_lids
from toongeo.render import ScaledOrthographicCamera, rasterize

BLINK = {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}


@pytest.fixture(scope="module", params=CARTOONS)
def stages(request, aligned, transferred):
    face, rig = aligned(request.param), transferred(request.param)
    eyes = fit_eyes(face, rig)
    cleared = keep_lids_outside(face, close_lids(face, seat_lids(face, rig, eyes), eyes), eyes)
    return face, eyes, cleared, rebuild_sockets(face, cleared, eyes)


def seen(face, rig, eyes, weights, yaw):
    """For each eye: pixels of both eyeballs and of the backs of triangles, as shares of the eyeball's disc."""
    V, F = rig.vertices(weights), face.faces
    first = np.cumsum([0, len(V), len(eyes.templates[0].vertices)])
    everything = np.vstack([V, eyes.vertices(0), eyes.vertices(1)])
    faces = np.vstack([F, *(eye.faces + start for eye, start in zip(eyes.templates, first[1:], strict=True))])
    for side in (0, 1):
        size, extent = 200, 3 * eyes.radii[side]
        camera = ScaledOrthographicCamera.look(yaw, 0, size=size, centre=eyes.centres[side], extent=extent)
        px = camera.project(everything)
        ids = rasterize(np.column_stack([px, camera.depth(everything)]), faces, size, size).face_ids
        a, b, c = (px[faces[:, k]] for k in range(3))
        back = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] > 0  # clockwise, as y points down
        disc = np.pi * (size / 3) ** 2
        around = face.region(f"socket_{SIDES[side]}")[faces[: len(F)]].any(1)
        shown = ids[ids >= 0]
        head = shown[shown < len(F)]
        yield (shown >= len(F)).sum() / disc, (back[head] & around[head]).sum() / disc


@pytest.mark.parametrize("yaw", [-30, 0, 30])
def test_closed_lids_show_no_eyeball(stages, yaw):
    face, eyes, _, rig = stages
    for eyeball, _ in seen(face, rig, eyes, BLINK, yaw):
        assert eyeball <= 0.005


@pytest.mark.parametrize("yaw", [-30, 0, 30])
def test_beside_an_eyeball_one_sees_no_inside_of_the_head(stages, yaw):
    face, eyes, _, rig = stages
    for weights in ({}, BLINK):
        for _, back in seen(face, rig, eyes, weights, yaw):
            assert back <= 0.005


def test_the_lining_goes_from_the_lids_into_the_eyeball(stages):
    face, eyes, _, rig = stages
    for side, name in enumerate(SIDES):
        band, _, _, share = _band(face.model, f"socket_{name}")
        assert 0 < share.min() < 0.3
        assert share.max() == 1
        for delta in (np.zeros_like(rig.neutral), *rig.deltas):
            distance = np.linalg.norm((rig.neutral + delta)[band] - eyes.centres[side], axis=1)
            np.testing.assert_allclose(distance[share == 1], DEPTH * eyes.radii[side], rtol=1e-5)


def test_only_sockets_are_lined(stages):
    face, _, before, after = stages
    others = ~(face.region("socket_left") | face.region("socket_right"))
    np.testing.assert_array_equal(after.neutral[others], before.neutral[others])
    np.testing.assert_array_equal(after.deltas[:, others], before.deltas[:, others])


def test_the_way_goes_straight_back_where_that_meets_the_eyeball(rng):
    rim = np.column_stack([rng.uniform(-5, 5, (20, 2)), np.full(20, 12.0)])
    lined = _lined(rim, np.zeros(3), 10.0, np.full(20, 0.5))
    np.testing.assert_allclose(lined[:, :2], rim[:, :2], rtol=1e-12)
    end = 2 * lined - rim
    np.testing.assert_allclose(np.linalg.norm(end, axis=1), 10 * DEPTH, rtol=1e-12)
    np.testing.assert_allclose(_lined(np.array([[30.0, 0, 2]]), np.zeros(3), 10.0, np.ones(1)), [[10 * DEPTH, 0, 0]])


def test_the_rim_itself_does_not_move(stages):
    face, _, before, after = stages
    for name in SIDES:
        rim = opening_rim(face.model, f"socket_{name}")
        np.testing.assert_array_equal(after.vertices(BLINK)[rim], before.vertices(BLINK)[rim])


def test_no_triangle_of_a_socket_loses_its_area(stages):
    face, _, _, rig = stages
    for name in SIDES:
        triangles = face.faces[face.region(f"socket_{name}")[face.faces].all(1)]
        a, b, c = (rig.neutral[triangles[:, k]] for k in range(3))
        assert (np.linalg.norm(np.cross(b - a, c - a), axis=1) > 1e-9).all()
