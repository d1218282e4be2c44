import dataclasses

import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo.metrics import mesh_quality
from toongeo.model.anatomy.eye_patch import eye_patch
from toongeo.model.anatomy.gaze import GAZE_NAMES
from toongeo.model.anatomy.lid_rings import lid_rings
from toongeo.model.anatomy.parts import SIDES
from toongeo.model.anatomy.rims import opening_rim, rim_path
from toongeo.pipeline import align_face, build_rig, fit_3dmm, fit_lids
from toongeo.pipeline.rig.eyes.lid_closure import lid_closure
from toongeo.pipeline.rig.eyes.visible_eyeballs import visible_eyeballs
from toongeo.pipeline.rig.skin import crossing_triangles
from toongeo.pipeline.rig.skin.crossing_triangles import crossing_all, resolve_crossings

BLINK = {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}
AROUND = ("browDown", "browInnerUp", "cheekSquint", "eyeBlink", "eyeSquint", "eyeWide", "mouthSmile")


@pytest.fixture(scope="module", params=CARTOONS)
def stages(request, aligned, transferred):
    face, rig = aligned(request.param), transferred(request.param)
    return face, rig, *fit_lids(face, rig)


@pytest.fixture(scope="module")
def drawn_shut(cartoon):
    """A face whose right eye is drawn shut: its points lie on a line."""
    img, landmarks = cartoon("moustache_man")
    landmarks = landmarks.copy()
    for upper, lower in ((37, 41), (38, 40)):
        landmarks[[upper, lower]] = landmarks[[upper, lower]].mean(0)
    face = align_face(fit_3dmm(img, landmarks), landmarks)
    return face, *fit_lids(face, build_rig(face))


def gaps(face, rig, eyes, side):
    """Distance of the lids' rims from the eyeball, of its radius."""
    name = SIDES[side]
    rim = np.r_[
        opening_rim(face.model, f"socket_{name}"),
        *(rim_path(face.model, f"lid_{k}_{name}") for k in ("upper", "lower")),
    ]
    return np.linalg.norm(rig.neutral[rim] - eyes.centres[side], axis=1) / eyes.radii[side] - 1


@pytest.mark.parametrize("side", [0, 1])
def test_neutral_lids_lie_on_the_eyeball(stages, side):
    face, _, rig, eyes = stages
    gap = gaps(face, rig, eyes, side)
    assert gap.min() > 0.01
    assert gap.max() <= 0.08


def test_bending_the_lids_leaves_the_picture_as_it_is(stages):
    face, transferred, rig, _ = stages
    near = np.any([face.region(f"eyelid_{k}_{s}") for k in ("upper", "lower") for s in SIDES], axis=0)
    landmarks = face.landmark_vertices
    # Hundredths of a pixel are allowed: what is still in the eyeball after the bending is pushed straight out of it.
    off = face.project(rig.neutral[landmarks]) - face.project(transferred.neutral[landmarks])
    assert np.abs(off).max() < 0.01
    moved = face.project(rig.neutral[near]) - face.project(transferred.neutral[near])
    assert np.median(np.abs(moved)) < 1e-9


@pytest.mark.parametrize("yaw", [-30, 0, 30])
def test_closed_lids_show_no_eyeball(stages, yaw):
    face, _, rig, eyes = stages
    assert visible_eyeballs(face, rig, eyes, BLINK, yaw=yaw).max() <= 0.005


@pytest.mark.parametrize(
    "others", [("mouthSmile",), ("eyeSquint",), ("cheekSquint",), ("mouthSmile", "eyeSquint"), ("eyeLookDown",)]
)
def test_closed_lids_show_no_eyeball_whatever_else_moves(stages, others):
    face, _, rig, eyes = stages
    weights = BLINK | {f"{name}{side}": 1.0 for name in others for side in ("Left", "Right")}
    assert visible_eyeballs(face, rig, eyes, weights).max() <= 0.005


def test_no_skin_is_inside_an_eyeball_in_any_expression_or_gaze(stages):
    face, _, rig, eyes = stages
    skin = face.region("skin")
    for shape in (np.zeros_like(rig.deltas[0]), *rig.deltas, *rig.gaze):
        for centre, radius in zip(eyes.centres, eyes.radii, strict=True):
            assert np.linalg.norm((rig.neutral + shape)[skin] - centre, axis=1).min() >= radius


@pytest.mark.parametrize("weight", [0.25, 0.5, 0.75])
def test_no_lid_is_inside_an_eyeball_on_its_way(stages, weight):
    face, _, rig, eyes = stages
    for side, name in enumerate(SIDES):
        lids = face.region(f"eyelid_upper_{name}") | face.region(f"eyelid_lower_{name}")
        for shape in (*rig.deltas, *rig.gaze):
            points = (rig.neutral + weight * shape)[lids]
            assert np.linalg.norm(points - eyes.centres[side], axis=1).min() >= 0.998 * eyes.radii[side]


def test_expressions_do_not_make_the_skin_intersect_itself(stages):
    face, _, rig, _ = stages
    F = face.faces[face.region("face")[face.faces].all(1)]
    allowed = len(mesh_quality(rig.neutral, F).intersecting) + 0.001 * len(F)
    for name in (f"{name}{side}" for name in AROUND for side in ("Left", "Right")):
        assert len(mesh_quality(rig.vertices({name: 1.0}), F).intersecting) <= allowed, name


def test_neutral_lids_cross_no_more_than_as_drawn(stages):
    face, transferred, rig, _ = stages
    F = face.faces[face.region("face")[face.faces].all(1)]
    before, after = (mesh_quality(r.neutral, F).intersecting for r in (transferred, rig))
    assert len(after) <= len(before)


def test_an_eye_that_is_drawn_shut_does_not_fold(drawn_shut):
    face, rig, _ = drawn_shut
    F = face.faces[face.region("face")[face.faces].all(1)]
    most = len(mesh_quality(face.vertices, F).intersecting) + 0.001 * len(F)
    assert len(mesh_quality(rig.neutral, F).intersecting) <= len(mesh_quality(face.vertices, F).intersecting)
    for name in ("eyeBlinkRight", "eyeSquintRight"):
        assert len(mesh_quality(rig.vertices({name: 1.0}), F).intersecting) <= most, name


@pytest.mark.parametrize("moved", [[[0.0, 0, 1]], [[0.0, 0, 1], [0.5, 0, 0]]])
def test_anchors_that_come_again_pull_as_the_first_time(model, moved):
    patch, at = eye_patch(model, "left"), lid_rings(model, "left").vertices
    moves = np.zeros((len(at), 3))
    moves[: len(moved)] = moved
    pulled = patch.pulled(model.mean, at, model.mean[at] + moves)
    for _ in range(2):
        np.testing.assert_allclose(model.mean[patch.vertices] + patch.followed(at, moves), pulled, atol=1e-9)


def test_ways_that_cross_are_made_alike(model):
    """A dent that is pushed out by the way of one vertex is smoothed, and what crosses is gone."""
    patch = eye_patch(model, "left")
    ways = np.zeros(model.mean.shape)
    ways[lid_rings(model, "left").upper[0, 12]] = [0.0, 8.0, 4.0]
    assert len(crossing_all(patch, model.mean + ways)) > 0
    better = resolve_crossings(model, patch, model.mean, ways, 0)
    assert len(crossing_all(patch, model.mean + better)) == 0
    np.testing.assert_array_equal(resolve_crossings(model, patch, model.mean, better, 0), better)


def test_crumpled_skin_is_given_up_at_once(model, monkeypatch):
    """Where most of it crosses, five rounds of smoothing take long and mend nothing."""
    patch = eye_patch(model, "left")
    ways = np.zeros(model.mean.shape)
    ways[patch.vertices] = np.random.default_rng(0).normal(0, 4, (len(patch.vertices), 3))
    looked = []

    def counted(*arguments):
        looked.append(crossing_all(*arguments))
        return looked[-1]

    monkeypatch.setattr(crossing_triangles, "crossing_all", counted)
    assert resolve_crossings(model, patch, model.mean, ways, 0) is ways
    assert len(looked) == 1 and len(looked[0]) > crossing_triangles.HOPELESS * len(patch.faces)


def test_both_eyes_are_reported_closed(stages):
    _, _, rig, _ = stages
    assert min(rig.report.closure_left, rig.report.closure_right) > 94


def test_without_closing_a_tall_eye_stays_open(aligned, transferred):
    face = aligned("manga_girl")
    rig, eyes = fit_lids(face, transferred("manga_girl"), close=False)
    assert visible_eyeballs(face, rig, eyes, BLINK).min() > 0.1
    assert max(rig.report.closure_left, rig.report.closure_right) < 80


def test_closure_is_the_share_of_the_opening_that_is_gone(model):
    rings = lid_rings(model, "left")
    half = model.mean.copy()
    half[rings.upper] = 0.5 * (model.mean[rings.upper] + model.mean[rings.lower])
    assert lid_closure(rings, model.mean, model.mean) == 0
    assert lid_closure(rings, model.mean, half) == pytest.approx(50, abs=8)


def test_an_eye_that_is_drawn_shut_stays_shut(drawn_shut):
    face, rig, eyes = drawn_shut
    assert rig.report.closure_right > 90
    assert gaps(face, rig, eyes, 1).max() <= 0.08
    assert visible_eyeballs(face, rig, eyes, BLINK)[1] <= 0.005
    blink = rig.deltas[rig.names.index("eyeBlinkRight")]
    open_blink = rig.deltas[rig.names.index("eyeBlinkLeft")]
    assert np.abs(blink).max() < 0.5 * np.abs(open_blink).max()


@pytest.mark.parametrize("side", SIDES)
def test_lids_follow_the_gaze(stages, side):
    face, _, rig, _ = stages
    shape = {name: rig.gaze[GAZE_NAMES.index(name)] for name in GAZE_NAMES}
    upper, lower = (lid[0, 8:-8] for lid in (lid_rings(face.model, side).upper, lid_rings(face.model, side).lower))
    up, down = (shape[f"eyeLook{look}{side.capitalize()}"] for look in ("Up", "Down"))
    assert up[upper, 1].mean() > 0 > down[upper, 1].mean()
    assert down[upper, 1].mean() < 2 * down[lower, 1].mean() < 0
    other = face.region(f"eye_{'right' if side == 'left' else 'left'}")
    assert not down[other & ~face.region(f"eye_{side}")].any()


def test_only_the_surroundings_of_the_eyes_change(stages):
    _, before, after, eyes = stages
    distance = np.linalg.norm(before.neutral[:, None] - eyes.centres, axis=2) / eyes.radii
    far = (distance > 3).all(1)
    np.testing.assert_array_equal(after.neutral[far], before.neutral[far])
    jaw = before.names.index("jawOpen")
    np.testing.assert_array_equal(after.deltas[jaw, far], before.deltas[jaw, far])


def test_the_same_face_gives_the_same_lids(aligned, transferred):
    face, rig = aligned("bad_guy"), transferred("bad_guy")
    (one, eyes), (two, again) = fit_lids(face, rig), fit_lids(face, rig)
    np.testing.assert_array_equal(one.neutral, two.neutral)
    np.testing.assert_array_equal(one.deltas, two.deltas)
    np.testing.assert_array_equal(eyes.centres, again.centres)


def test_lids_without_rings_are_refused(model):
    quads = model.quads.copy()
    quads[np.isin(quads, opening_rim(model, "socket_left")).any(1)] = quads[0]
    with pytest.raises(ValueError, match="rings of quads around socket_left"):
        lid_rings(dataclasses.replace(model, quads=quads), "left")
