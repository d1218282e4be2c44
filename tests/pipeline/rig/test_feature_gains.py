"""Expressions that travel in proportion to their feature."""

import dataclasses

import numpy as np
import pytest

from toongeo import build_rig
from toongeo.model.expression_features import FEATURE_OF
from toongeo.pipeline.rig.feature_gains import feature_gains


@pytest.fixture(scope="module")
def face(aligned):
    return aligned("moustache_man")


def with_vertices(face, V):
    return dataclasses.replace(face, vertices=V)


def travel(rig, model, name, points):
    delta = rig.deltas[rig.names.index(name)][model.landmarks[points]]
    return np.sqrt((delta.astype(float) ** 2).sum(1).mean())


def test_the_template_itself_has_gain_one_exactly(face, model):
    plain = build_rig(with_vertices(face, model.mean))
    auto = build_rig(with_vertices(face, model.mean), gain="auto")
    np.testing.assert_allclose(auto.deltas, plain.deltas, rtol=0, atol=5e-4)  # mm


def test_a_face_of_another_size_moves_in_proportion(face, model):
    auto = build_rig(with_vertices(face, 1.5 * model.mean), gain="auto")
    skin = model.region("skin")
    expected = 1.5 * build_rig(with_vertices(face, model.mean)).deltas[:, skin]
    np.testing.assert_allclose(auto.deltas[:, skin], expected, atol=1e-3)


def test_a_mouth_twice_as_wide_opens_twice_as_far(face, model):
    """The corners are drawn outwards, the middle of the lips stays: plain transfer opens it as far as before."""
    centre = model.mean[model.landmarks[48:]].mean(0)
    offset = model.mean - centre
    width = np.abs(offset[model.landmarks[[48, 54]], 0]).mean()
    beside, above = offset[:, 0] / width, offset[:, 1] / width
    fade = np.exp(-(above**2) / 2) * np.where(offset[:, 2] > -1.5 * width, 1.0, 0.0)
    V = model.mean.copy()
    V[:, 0] += width * np.sign(beside) * np.minimum(np.abs(beside), 1.0) * fade
    corners = V[model.landmarks[[48, 54]], 0]
    assert np.ptp(corners) == pytest.approx(4 * width, rel=0.05)
    plain, auto = build_rig(with_vertices(face, V)), build_rig(with_vertices(face, V), gain="auto")
    template = build_rig(with_vertices(face, model.mean))
    mouth = list(range(48, 68))
    ratio = travel(auto, model, "jawOpen", mouth) / travel(template, model, "jawOpen", mouth)
    assert ratio == pytest.approx(np.ptp(corners) / (2 * width), rel=0.01)
    assert travel(plain, model, "jawOpen", mouth) < 0.75 * travel(auto, model, "jawOpen", mouth)
    for k, name in enumerate(plain.names):  # brows and eyes are as they were
        if FEATURE_OF.get(name, "mouth") not in ("mouth", "nose"):
            np.testing.assert_allclose(auto.deltas[k], plain.deltas[k], atol=0.02 * np.abs(plain.deltas[k]).max())


def test_a_number_multiplies_all_blendshapes(face):
    """I + g (Q - I) in each gradient: the system is linear in them."""
    np.testing.assert_allclose(build_rig(face, gain=1.5).deltas, 1.5 * build_rig(face).deltas, rtol=1e-6)


def test_gains_keep_within_their_range(face, model):
    tiny = model.mean.copy()
    mouth = model.landmarks[48:]
    near = np.linalg.norm(tiny - tiny[mouth].mean(0), axis=1)
    tiny[:, 0] = np.where(near < 80, tiny[:, 0] * (1 - 0.9 * np.exp(-((near / 40) ** 2))), tiny[:, 0])
    plain, auto = build_rig(with_vertices(face, tiny)), build_rig(with_vertices(face, tiny), gain="auto")
    for k, name in enumerate(plain.names):
        peak = np.unravel_index(np.abs(plain.deltas[k]).argmax(), plain.deltas[k].shape)
        assert 0.5 - 1e-6 <= auto.deltas[k][peak] / plain.deltas[k][peak] <= 2 + 1e-6, name


@pytest.mark.parametrize(
    ("slower", "expected"), [(1.0, 1.0), (1.6, 1.6), (2.5, 2.0), (9.0, 2.0), (0.7, 0.7), (0.3, 0.5)]
)
def test_the_gain_is_the_travel_that_lacks_from_a_half_to_twice(face, model, slower, expected):
    on_template = build_rig(with_vertices(face, model.mean)).deltas
    gains = feature_gains(model, model.mean, on_template / slower)
    featured = np.array([name in FEATURE_OF for name in model.expression_names[: len(gains)]])
    assert featured.sum() > 30
    np.testing.assert_allclose(gains, np.where(featured, expected, 1.0), rtol=1e-5)


@pytest.mark.parametrize("gain", ["much", 0, -1.0, float("nan"), None])
def test_a_gain_that_is_none_is_refused(face, gain):
    with pytest.raises(ValueError, match="gain: expected a positive number or 'auto', got"):
        build_rig(face, gain=gain)


def test_a_face_without_correspondence_is_refused(face):
    with pytest.raises(ValueError, match=r"face: expected vertices of shape .* got \(10, 3\); another mesh has to be"):
        build_rig(with_vertices(face, np.zeros((10, 3))))
