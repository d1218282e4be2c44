"""The eyeball's sphere: closed, outward, symmetric, with a single-valued disc."""

import doctest
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "data_templates" / "build"))

import eyeball
from eyeball import eyeball_sphere


@pytest.fixture(params=[8, 24, 32])
def ball(request):
    return eyeball_sphere(request.param)


def test_unit_radius_and_one_front_pole(ball):
    V = ball["vertices"]
    np.testing.assert_allclose(np.linalg.norm(V, axis=1), 1.0, atol=1e-15)
    assert (V[:, 2] == 1).sum() == 1
    np.testing.assert_array_equal(V[0], [0, 0, 1])


def test_closed_and_outward_once_the_back_pole_is_merged(ball):
    V, F = ball["vertices"], ball["faces"]
    F = np.where(V[F][:, :, 2] == -1, len(V), F)
    directed = np.stack([F, np.roll(F, -1, axis=1)], -1).reshape(-1, 2)
    assert len(np.unique(directed, axis=0)) == len(directed)  # consistent winding, no edge in three faces
    assert {tuple(e) for e in directed} == {tuple(e[::-1]) for e in directed}  # no boundary
    edges = len(directed) // 2
    assert len(np.unique(F)) - edges + len(F) == 2  # a sphere
    a, b, c = V[ball["faces"]].swapaxes(0, 1)
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c) > 0).all()


def test_volume_nears_that_of_the_ball():
    volumes = []
    for sectors in (24, 96):
        ball = eyeball_sphere(sectors)
        a, b, c = ball["vertices"][ball["faces"]].swapaxes(0, 1)
        volumes.append(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)
    assert 0.95 < volumes[0] / (4 / 3 * np.pi) < volumes[1] / (4 / 3 * np.pi) < 1


def test_rings_lie_at_the_limbus_and_round_the_pupil(ball):
    polar = np.unique(np.arccos(np.clip(ball["vertices"][:, 2], -1, 1)).round(9))
    assert np.abs(polar - ball["iris_angle"]).min() < 1e-8
    assert (np.abs(polar - ball["pupil_angle"]) < 0.07 * ball["pupil_angle"]).sum() == 2


@pytest.mark.parametrize("radius", [12.0, 15.1])
def test_iris_has_its_measured_width_on_any_globe(radius):
    ball = eyeball_sphere(radius_mm=radius)
    assert 2 * radius * np.sin(ball["iris_angle"]) == pytest.approx(11.71)
    assert 2 * radius * np.sin(ball["pupil_angle"]) == pytest.approx(3.8)


def test_disc_is_single_valued_and_has_no_flipped_face(ball):
    V, F, disc = ball["vertices"], ball["faces"], ball["disc"]
    a, b, c = disc[F].swapaxes(0, 1)
    ab, ac = b - a, c - a
    assert (ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0] > 1e-5).all()  # and rings nest: no overlap
    radius = np.hypot(*disc.T)
    assert radius.max() == pytest.approx(1.0)
    order = np.argsort(-V[:, 2], kind="stable")
    assert (np.diff(radius[order]) > -1e-12).all()  # monotone in the polar angle
    side = np.hypot(V[:, 0], V[:, 1]) > 1e-9
    across = V[side, 0] * disc[side, 1] - V[side, 1] * disc[side, 0]
    np.testing.assert_allclose(across, 0, atol=1e-15)  # the azimuth is kept
    iris = V[:, 2] >= np.cos(ball["iris_angle"]) - 1e-9
    assert radius[iris].max() == pytest.approx(0.36)


def test_mirror_symmetry_is_exact(ball):
    key = [tuple(row) for row in np.hstack([ball["vertices"], ball["disc"]]) + 0.0]
    index = {k: i for i, k in enumerate(key)}
    assert len(index) == len(key)
    flip = np.array([-1, 1, 1, -1, 1])
    mirror = np.array([index[tuple(flip * np.array(k) + 0.0)] for k in key])
    faces = {frozenset(f) for f in ball["faces"].tolist()}
    assert {frozenset(mirror[list(f)].tolist()) for f in faces} == faces
    np.testing.assert_array_equal(ball["colour"], ball["colour"][mirror])


def test_colours_are_pupil_iris_and_white(ball):
    colour, z = ball["colour"], ball["vertices"][:, 2]
    assert colour.min() >= 0 and colour.max() <= 1
    assert colour[z > np.cos(0.98 * ball["pupil_angle"])].max() < 0.1
    white = (z < np.cos(1.2 * ball["iris_angle"])) & (z > 0.2)
    assert colour[white].min() > 0.8


def test_bad_arguments():
    for sectors in (6, 10, 25):
        with pytest.raises(ValueError, match="sectors: expected a multiple of 4"):
            eyeball_sphere(sectors)
    with pytest.raises(ValueError, match="radius_mm: expected at least 11, got 5"):
        eyeball_sphere(radius_mm=5)


def test_doctest():
    assert doctest.testmod(eyeball).failed == 0
