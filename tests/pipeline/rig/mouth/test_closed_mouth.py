"""Mouths that are drawn open: closed as curves, and opened again as they were."""

import numpy as np
import pytest

from toongeo.geometry.polyline import arc_shares, interpolated
from toongeo.model.anatomy.lip_line import lip_line
from toongeo.model.anatomy.lips_apart import lips_apart
from toongeo.model.anatomy.motion_shares import motion_shares
from toongeo.pipeline import build_rig, fit_mouth, neutral_face
from toongeo.pipeline.rig.fit_pose import fit_pose
from toongeo.pipeline.rig.mouth.contact_line import contact_line
from toongeo.pipeline.rig.mouth.lower_face import crossing_count, strain, uncrossed
from toongeo.pipeline.rig.mouth.open_as_drawn import OPENING, open_as_drawn

UP = np.array([0.0, 1.0, 0.0])
OPEN_MM = 20.0  # of the template's philtrum and more


@pytest.fixture(scope="module")
def opened(model):
    return model.mean + 0.5 * model.expression[model.expression_index("jawOpen")]


@pytest.fixture(scope="module")
def drawn(aligned):
    """A face that is drawn with an open mouth, and how it is at rest."""
    face = aligned("astronaut")
    return face, neutral_face(face)


@pytest.fixture(scope="module")
def drawn_thin(aligned):
    """A mouth that is drawn as a wedge, whose lips have no height."""
    face = aligned("bad_guy")
    return face, neutral_face(face)


def moved_lines(model, V, up=UP, philtrum=OPEN_MM):
    line = lip_line(model)
    to_upper, to_lower = contact_line(line, V, up, philtrum)
    return V[line.upper] + to_upper, V[line.lower] + to_lower


def test_lips_meet_all_along_with_a_gap_that_does_not_count_as_contact(model, opened):
    upper, lower = moved_lines(model, opened)
    width = np.linalg.norm(upper[-1] - upper[0])
    apart = interpolated(arc_shares(lower), arc_shares(upper), upper) - lower
    assert np.linalg.norm(apart, axis=1).max() < 0.01 * width
    assert (apart[2:-2, 1] > 0).all()
    np.testing.assert_allclose(upper[[0, -1]], lower[[0, -1]], atol=1e-9)


@pytest.mark.parametrize("scale", [1e-2, 1e2])
def test_the_line_scales_and_turns_with_the_face(model, opened, scale):
    angle = 0.3
    R = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]])
    for plain, turned in zip(
        moved_lines(model, opened),
        moved_lines(model, scale * opened @ R.T, R @ UP, scale * OPEN_MM),
        strict=True,
    ):
        np.testing.assert_allclose(turned, scale * plain @ R.T, atol=1e-9 * scale * 100)


def test_the_upper_lip_comes_down_by_no_more_than_its_height_allows(model, opened):
    line = lip_line(model)
    upper, _ = moved_lines(model, opened, philtrum=0.0)
    down = opened[line.upper, 1] - upper[:, 1]
    gap = np.linalg.norm(opened[model.landmarks[62]] - opened[model.landmarks[66]])
    assert down[len(down) // 2] < 0.1 * gap


def test_lips_that_are_drawn_wavy_meet_at_one_arc(model, opened):
    line = lip_line(model)
    wavy, at = opened.copy(), arc_shares(opened[line.upper])
    wavy[line.upper, 1] += 2.0 * np.sin(6 * np.pi * at)
    upper, _ = moved_lines(model, wavy)
    at = arc_shares(wavy[line.upper])
    full = (at > 0.05) & (at < 0.95)  # the gap fades out towards the corners
    waves = upper[full, 1] - np.polynomial.Polynomial.fit(at[full], upper[full, 1], 4)(at[full])
    assert np.abs(waves).max() < 1e-9


def test_a_lip_that_is_drawn_as_a_line_closes_without_crossings(drawn_thin):
    face, at_rest = drawn_thin
    model = face.model
    assert crossing_count(model, at_rest.vertices) == 0
    # mean distance of the lips in widths of the mouth: closed, that is, to the gap between them
    assert lips_apart(model, at_rest.vertices) < 0.011 < lips_apart(model, face.vertices)


def test_strain_of_a_uniform_stretch_is_its_factor(model):
    assert strain(model, model.mean, 1.7 * model.mean) == pytest.approx(1.7, rel=1e-6)
    assert strain(model, model.mean, model.mean * [1, 1.5, 1]) == pytest.approx(1.5, rel=0.01)


def test_what_crosses_is_smoothed_and_what_does_not_stays(model):
    same = uncrossed(model, model.mean)
    assert same is model.mean and crossing_count(model, model.mean) == 0
    poked = model.mean.copy()
    chin = model.landmarks[57]
    poked[chin] += [9.0, 0, -2]
    assert crossing_count(model, poked) > 0
    mended = uncrossed(model, poked)
    assert crossing_count(model, mended) == 0
    far = np.linalg.norm(model.mean - model.mean[chin], axis=1) > 40
    np.testing.assert_array_equal(mended[far], poked[far])


def test_the_rig_shows_the_mouth_as_it_is_drawn(drawn):
    face, rest = drawn
    plain = build_rig(rest)
    rig = open_as_drawn(rest, plain, face.vertices)
    mouth, skin = face.region("mouth"), face.region("skin")
    misses = []
    for shapes in (plain, rig):
        shown = shapes.vertices(fit_pose(shapes, face.vertices, skin))
        misses.append(np.sqrt(((shown - face.vertices)[mouth] ** 2).sum(1).mean()))
    width = np.linalg.norm(np.subtract(*face.vertices[face.model.landmarks[[48, 54]]]))
    assert misses[1] < 0.005 * width < misses[0]
    np.testing.assert_array_equal(rig.neutral, plain.neutral)


def test_with_all_contacts_it_still_does_and_the_lips_seal(drawn, model):
    face, rest = drawn
    rig = fit_mouth(rest, build_rig(rest), face.vertices)
    shown = rig.vertices(fit_pose(rig, face.vertices, face.region("skin")))
    width = np.linalg.norm(np.subtract(*face.vertices[model.landmarks[[48, 54]]]))
    assert np.sqrt(((shown - face.vertices)[face.region("mouth")] ** 2).sum(1).mean()) < 0.01 * width
    assert lips_apart(model, rig.vertices({"jawOpen": 1.0, "mouthClose": 1.0})) < 0.01
    assert rig.report.lips_closure > 95


def test_a_ridge_makes_weights_smaller(drawn):
    face, rest = drawn
    rig, skin = build_rig(rest), face.region("skin")
    small, large = (fit_pose(rig, face.vertices, skin, ridge=ridge).sum() for ridge in (1e-6, 1e-1))
    assert 0 < large < small


def test_only_what_opens_or_smiles_changes_and_only_where_the_template_moves(drawn, model):
    face, rest = drawn
    plain = build_rig(rest)
    rig = open_as_drawn(rest, plain, face.vertices)
    for k, name in enumerate(rig.names):
        change = np.abs(rig.deltas[k] - plain.deltas[k]).max(1)
        if name in OPENING:
            assert change[motion_shares(model)[k] == 0].max() == 0
        elif not name.startswith(("mouthSmile", "mouthDimple", "mouthStretch", "mouthPress")):
            assert change.max() == 0, name
    smile = rig.names.index("mouthSmileLeft")
    left = 1 - rest.fit.expression[model.expression_index("mouthSmileLeft")]
    np.testing.assert_allclose(rig.deltas[smile], max(left, 0.35) * plain.deltas[smile], atol=1e-5)


def test_a_closed_mouth_is_less_apart_the_wider_it_is(model, opened):
    assert lips_apart(model, opened) == pytest.approx(lips_apart(model, 3 * opened))
    assert lips_apart(model, model.mean) < lips_apart(model, opened)
