"""Longitude and latitude in place of texture coordinates."""

from dataclasses import replace

import numpy as np
import pytest

from toongeo.model.atlas_coordinates import atlas_coordinates


@pytest.fixture(scope="module")
def bare(model):
    return replace(model, uv=np.zeros((0, 2)), uv_faces=np.zeros((0, 3), int))


def test_each_corner_is_its_vertex_and_no_triangle_spans_the_seam(bare):
    atlas = atlas_coordinates(bare)
    vertex = np.full(len(atlas.uv), -1)
    vertex[atlas.uv_faces] = bare.faces
    assert (vertex >= 0).all()
    again = np.flatnonzero(vertex != np.arange(len(vertex)))
    assert 0 < len(again) < 200
    np.testing.assert_allclose(atlas.uv[again, 1], atlas.uv[vertex[again], 1])  # a turn apart, at the same latitude
    behind = bare.region("scalp")[bare.faces].all(1) & (bare.mean[bare.faces][:, :, 1].max(1) < 60)
    width = np.ptp(atlas.uv[atlas.uv_faces[behind]][:, :, 0], axis=1)
    assert width.max() < 0.05


def test_east_is_the_subjects_left_and_north_is_up(bare):
    at = atlas_coordinates(bare).uv[bare.landmarks]
    assert at[45, 0] > at[36, 0] + 0.02 and at[27, 1] > at[8, 1] + 0.02


def test_eyeballs_keep_their_place(bare):
    uv = atlas_coordinates(bare).uv
    discs = np.concatenate([eye.uv for eye in bare.eyes])
    low, high = discs.min(0), discs.max(0)
    assert not ((uv >= low) & (uv <= high)).all(1).any() and uv.min() > 0 and uv.max() < 1
    assert np.ptp(atlas_coordinates(replace(bare, eyes=())).uv, axis=0).min() > np.ptp(uv, axis=0).min()


def test_where_two_surfaces_share_a_place_the_outer_one_is_higher(bare):
    height = atlas_coordinates(bare).height[: len(bare.mean)]
    assert height[bare.region("lips")].min() > height[bare.region("tongue")].min()
    assert height[bare.region("nose")].mean() > height[bare.region("mouth_cavity")].mean()
