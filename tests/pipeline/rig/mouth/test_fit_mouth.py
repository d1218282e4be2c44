import dataclasses

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tests.conftest import CARTOONS
from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.metrics import mesh_quality
from toongeo.model.anatomy.lip_line import lip_line
from toongeo.model.anatomy.parts import TEETH_AND_TONGUE
from toongeo.model.expression_weights import preset
from toongeo.pipeline import build_rig, fit_mouth, neutral_face
from toongeo.pipeline.align.keep_teeth_inside import enclosed
from toongeo.pipeline.rig.mouth.close_slit import close_slit
from toongeo.pipeline.rig.mouth.hang_teeth import hang_teeth
from toongeo.pipeline.rig.mouth.lower_face import crossing_count
from toongeo.pipeline.rig.mouth.open_as_drawn import open_as_drawn
from toongeo.pipeline.rig.mouth.seal_lips import GAP, _heights, _up, seal_lips
from toongeo.pipeline.rig.mouth.unfold_mouth import unfold_mouth
from toongeo.render import ScaledOrthographicCamera, rasterize

SEALED = {"jawOpen": 1.0, "mouthClose": 1.0}
MOUTH = ("mouth", "jaw", "cheekPuff", "nose", "tongue")


@pytest.fixture(scope="module", params=CARTOONS)
def stages(request, aligned, transferred):
    face, rig = aligned(request.param), transferred(request.param)
    return face, rig, fit_mouth(face, rig)


@pytest.fixture(scope="module")
def closed_mouth(aligned, transferred):
    """A mouth that is drawn closed, with points of the lips a little apart."""
    return aligned("moustache_man"), transferred("moustache_man")


def width(model, V):
    line = lip_line(model)
    return np.linalg.norm(V[line.upper[-1]] - V[line.upper[0]])


def dense(path):
    steps = np.linspace(0, 1, 20)[:, None, None]
    return (path[:-1] + steps * np.diff(path, axis=0)).reshape(-1, 3)


def heights(model, V, up):
    """Of the lines alone, of upper over lower and lower under upper lip."""
    line = lip_line(model)
    return [side[: len(path)] for side, path in zip(_heights(line, V, up), (line.upper, line.lower), strict=True)]


def intersecting(model, V):
    used, F = np.unique(model.faces[model.region("face")[model.faces].all(1)], return_inverse=True)
    return 100 * mesh_quality(V[used], F.reshape(-1, 3)).intersecting_fraction


def test_mouth_close_seals_the_lips_of_an_open_jaw(stages):
    face, _, rig = stages
    line, V = lip_line(face.model), rig.vertices(SEALED)
    upper, lower = dense(V[line.upper]), dense(V[line.lower])
    gap = max(cKDTree(upper).query(lower)[0].max(), cKDTree(lower).query(upper)[0].max())
    assert gap < 0.01 * width(face.model, V)
    assert rig.report.lips_closure > 99


@pytest.mark.parametrize("weights", [{"mouthPucker": 1.0}, preset("kiss")])
def test_a_kiss_is_one_of_closed_lips(stages, weights):
    face, _, rig = stages
    line, V = lip_line(face.model), rig.vertices(weights)
    upper, lower = dense(V[line.upper]), dense(V[line.lower])
    gap = max(cKDTree(upper).query(lower)[0].max(), cKDTree(lower).query(upper)[0].max())
    assert gap < 0.02 * width(face.model, V)


def test_sealed_lips_are_as_far_apart_as_told_where_they_are_paired(stages):
    face, _, rig = stages
    line, V = lip_line(face.model), rig.vertices(SEALED)
    upper, lower = V[line.upper], V[line.lower]
    apart = interpolated(arc_shares(lower), arc_shares(upper), upper) - lower
    assert np.linalg.norm(apart, axis=1).max() < 4 * GAP * width(face.model, V)


def test_no_lip_is_beyond_the_other_where_it_was_not_in_the_aligned_face(stages):
    face, _, rig = stages
    up = _up(lip_line(face.model), rig.neutral)
    neutral = heights(face.model, face.vertices, up)
    for name, delta in zip(rig.names, rig.deltas, strict=True):
        if name == "mouthClose":  # a corrective of jawOpen
            continue
        V = rig.neutral + delta
        for rest, height in zip(neutral, heights(face.model, V, up), strict=True):
            assert (np.minimum(rest, 0) - height).max() < 0.003 * width(face.model, V), name


def test_lips_that_are_far_enough_apart_stay_as_they_are(stages):
    face, transferred, _ = stages
    sealed = seal_lips(face, transferred)
    still = [k for k, name in enumerate(sealed.names) if name.startswith("brow")]
    np.testing.assert_array_equal(sealed.deltas[still], transferred.deltas[still])
    np.testing.assert_array_equal(sealed.neutral, transferred.neutral)
    far = np.ones(len(face.vertices), bool)
    far[lip_line(face.model).follows] = False
    np.testing.assert_array_equal(sealed.deltas[:, far], transferred.deltas[:, far])


def test_lips_that_cross_in_the_neutral_face_are_parted(closed_mouth):
    face, rig = closed_mouth
    line = lip_line(face.model)
    up = _up(line, rig.neutral)
    crossed = rig.neutral.copy()
    down = np.zeros((len(line.vertices), 3))
    down[: len(line.upper)] = -3 * np.sin(np.pi * arc_shares(crossed[line.upper]))[:, None] * up
    crossed[line.follows] += line.spread @ down
    assert heights(face.model, crossed, up)[0].min() < -0.5
    parted = seal_lips(face, dataclasses.replace(rig, neutral=crossed)).neutral
    assert heights(face.model, parted, up)[0].min() > -0.003 * width(face.model, parted)


def test_expressions_of_the_mouth_intersect_little_more_than_on_the_template(stages):
    face, _, rig = stages
    model, neutral = face.model, intersecting(face.model, rig.neutral)
    for k, name in enumerate(rig.names):
        if name in ("mouthRollLower", "mouthRollUpper", "mouthFunnel", "mouthPucker", "jawRight"):
            # 0 on the template
            assert intersecting(model, rig.neutral + rig.deltas[k]) <= neutral + 0.16, name


def test_nothing_comes_out_of_the_mouth_but_the_tongue(stages):
    face, _, rig = stages
    for weights in ({}, {"jawOpen": 1.0}, SEALED, {"jawForward": 1.0}, {"mouthRollUpper": 1.0}, {"tongueOut": 1.0}):
        V = rig.vertices(weights)
        held = np.any(
            [face.region(part) for part in TEETH_AND_TONGUE if not (part == "tongue" and "tongueOut" in weights)],
            axis=0,
        )
        assert enclosed(face.model, V, V[held][::5]).all(), weights


def test_upper_teeth_stay_and_lower_ones_turn_as_on_the_template(stages):
    face, _, rig = stages
    model = face.model
    upper, lower = model.region("teeth_upper"), model.region("teeth_lower")
    assert not rig.deltas[:, upper].any()
    jaw = rig.deltas[rig.names.index("jawOpen")][lower]
    shape = model.expression[model.expression_index("jawOpen")][lower]
    rest = rig.neutral[lower] - rig.neutral[lower].mean(0)
    turned = rest + jaw - jaw.mean(0)
    np.testing.assert_allclose((turned**2).sum(), (rest**2).sum(), rtol=2e-2)  # a rotation
    assert jaw.mean(0) @ shape.mean(0) > 0.5 * (shape.mean(0) ** 2).sum()


def test_lower_teeth_go_as_far_as_the_chin(closed_mouth):
    face, rig = closed_mouth
    jaw, lower = rig.names.index("jawOpen"), face.region("teeth_lower")
    chin = face.region("jaw")
    deltas = rig.deltas.copy()
    deltas[jaw, chin] = 1.25 * face.model.expression[face.model.expression_index("jawOpen")][chin]
    hung = hang_teeth(face, dataclasses.replace(rig, deltas=deltas))
    shape = face.model.expression[face.model.expression_index("jawOpen")][lower]
    np.testing.assert_allclose(hung.deltas[jaw, lower].mean(0), 1.25 * shape.mean(0), atol=1e-3)


def test_teeth_that_came_out_are_drawn_back(closed_mouth):
    face, rig = closed_mouth
    jaw, lower = rig.names.index("jawForward"), face.region("teeth_lower")
    deltas = rig.deltas.copy()
    deltas[jaw, ~(lower | face.region("tongue"))] = 0  # the jaw's teeth go forward, its skin does not
    deltas[jaw, face.region("jaw")] = face.model.expression[jaw][face.region("jaw")] * 3
    deltas[jaw, face.region("mouth")] = 0
    rig = dataclasses.replace(rig, deltas=deltas)
    hung = hang_teeth(face, rig)
    V = hung.neutral + hung.deltas[jaw]
    assert enclosed(face.model, V, V[lower]).all()


def test_a_closed_mouth_is_shut_without_a_change_to_its_picture(closed_mouth):
    face, rig = closed_mouth
    shut = close_slit(face, rig)
    skin = ~face.region("mouth_cavity")
    np.testing.assert_allclose(face.project(shut.neutral[skin]), face.project(rig.neutral[skin]), atol=1e-9)
    line = lip_line(face.model)
    depth = []
    for V in (rig.neutral, shut.neutral):
        opposite = interpolated(arc_shares(V[line.lower]), arc_shares(V[line.upper]), V[line.upper])
        depth.append(np.abs(opposite - V[line.lower])[3:-3, 2].max())
    assert depth[1] < 0.5 * depth[0]


@pytest.mark.parametrize("yaw", [0.0, 30.0, -30.0, 60.0, -60.0])
def test_no_tooth_shows_between_closed_lips(closed_mouth, yaw):
    face, rig = closed_mouth
    V, model = fit_mouth(face, rig).neutral, face.model
    line = lip_line(model)
    size, extent = 300, 1.5 * width(model, V)
    camera = ScaledOrthographicCamera.look(yaw, 0, size=size, centre=V[line.vertices].mean(0), extent=extent)
    ids = rasterize(np.column_stack([camera.project(V), camera.depth(V)]), model.faces, size, size).face_ids
    teeth = np.any([model.region(part) for part in TEETH_AND_TONGUE], axis=0)[model.faces].any(1)
    assert not teeth[np.unique(ids[ids >= 0])].any()


def test_an_open_mouth_stays_open(aligned, transferred):
    face, rig = aligned("manga_girl"), transferred("manga_girl")
    assert close_slit(face, rig) is rig


FOLDING = ("mouthPucker", "mouthSmileLeft", "mouthSmileRight", "mouthUpperUpRight", "mouthRight")


@pytest.fixture(scope="module")
def folded(aligned):
    """A mouth drawn open with thin lips, closed, and its rig before and after its skin is unfolded."""
    drawn = aligned("bad_guy")
    face = neutral_face(drawn)
    rig = seal_lips(face, close_slit(face, build_rig(face)))
    rig = seal_lips(face, open_as_drawn(face, rig, drawn.vertices))
    return face, rig, unfold_mouth(face, rig)


def test_expressions_push_less_skin_through_skin(folded):
    face, before, after = folded
    counts = np.array(
        [[crossing_count(face.model, rig.vertices({name: 1.0})) for rig in (before, after)] for name in FOLDING]
    )
    assert (counts[:, 1] <= counts[:, 0]).all()
    assert counts[:, 1].sum() < 0.3 * counts[:, 0].sum()
    assert counts[:, 1].max() <= 13


def test_unfolded_skin_stays_where_it_was_still_and_seals_as_before(folded):
    _, before, after = folded
    still = ~before.deltas.any(2)
    assert not after.deltas[still].any()
    np.testing.assert_array_equal(after.neutral, before.neutral)
    np.testing.assert_allclose(after.vertices(SEALED), before.vertices(SEALED), atol=1e-4)


def test_expressions_that_do_not_fold_are_left_alone(folded):
    _, before, after = folded
    for name in ("browInnerUpLeft", "eyeBlinkLeft", "tongueOut"):
        k = before.names.index(name)
        np.testing.assert_array_equal(after.deltas[k], before.deltas[k])
