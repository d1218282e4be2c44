"""Motions made affine around vertices."""

import numpy as np
import pytest

from toongeo.geometry import adjacency
from toongeo.pipeline.rig.mouth.lower_face import crossing_count, crossings
from toongeo.pipeline.rig.skin.affine_around import affine_around

CORE, FADE = 2, 3


@pytest.fixture(scope="module")
def corner(model):
    return model.landmarks[[48]]


def steps_from(model, vertices, count):
    """Which vertices are so many edges away, or fewer."""
    near = np.isin(np.arange(len(model.mean)), vertices)
    for _ in range(count):
        near |= adjacency(model.faces, len(model.mean)).astype(bool) @ near
    return near


def test_the_core_moves_affinely_and_what_is_beyond_as_before(model, corner):
    end = model.mean + np.random.default_rng(0).normal(size=model.mean.shape)
    moved = affine_around(model, model.mean, end, corner, CORE, FADE)
    core = steps_from(model, corner, CORE) & model.region("face")
    start = np.column_stack([model.mean[core], np.ones(core.sum())])
    shares, *_ = np.linalg.lstsq(start, moved[core], rcond=None)
    np.testing.assert_allclose(start @ shares, moved[core], atol=1e-9)
    beyond = ~steps_from(model, corner, CORE + FADE)
    np.testing.assert_array_equal(moved[beyond], end[beyond])


def test_a_shift_stays_what_it_is(model, corner):
    end = model.mean + [1.0, -2.0, 0.5]
    np.testing.assert_allclose(affine_around(model, model.mean, end, corner, CORE, FADE), end, atol=1e-9)


def test_both_corners_have_a_map_of_their_own(model):
    sides = np.sign(model.mean[:, :1])
    end = model.mean + sides * [0.0, 3.0, 0.0]
    moved = affine_around(model, model.mean, end, model.landmarks[[48, 54]], CORE, FADE)
    np.testing.assert_allclose(moved[model.landmarks[[48, 54]]], end[model.landmarks[[48, 54]]], atol=1e-9)


def test_skin_that_was_pushed_through_skin_no_longer_is(model):
    end = model.mean.copy()
    end[model.landmarks[57]] += [9.0, 0.0, -2.0]
    hit = crossings(model, end)
    assert len(hit) > 0
    moved = affine_around(model, model.mean, end, model.faces[hit], CORE, FADE)
    assert crossing_count(model, moved) == 0
