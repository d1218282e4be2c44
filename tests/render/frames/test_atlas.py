"""One picture of all textures and colours."""

import numpy as np
import pytest

from toongeo.render.frames import atlas as module
from toongeo.render.frames.atlas import atlas_of
from toongeo.render.paint_table import PaintTable
from toongeo.render.sample_image import sample_image

GROUND = np.array([0.1, 0.2, 0.3])


def table_of(texture_of, texels, colours):
    return PaintTable(np.concatenate([texels, colours], axis=2).astype(np.float32), texture_of, ())


@pytest.fixture
def textures():
    rng = np.random.default_rng(0)
    return [rng.random((height, width, 3), np.float32) for height, width in ((8, 30), (20, 10), (5, 5))]


@pytest.mark.parametrize("width", [2**14, 60])
def test_texels_have_the_colours_of_the_textures_in_and_at_their_borders(width, textures, monkeypatch):
    monkeypatch.setattr(module, "_WIDTH", width)  # on one shelf, or on several
    rng = np.random.default_rng(1)
    texture_of = np.arange(12) % 3
    sides = np.array([texture.shape[1::-1] for texture in textures])[texture_of]
    texels = rng.uniform(-0.5, 1, (12, 3, 2)) * (sides[:, None] - 0.5)
    atlas = atlas_of(table_of(texture_of, texels, np.ones((12, 3, 3))), textures, GROUND)
    assert atlas.picture.shape[1] <= width
    for k, index in enumerate(texture_of):
        seen, given = sample_image(atlas.picture, atlas.texels[k]), sample_image(textures[index], texels[k])
        np.testing.assert_allclose(seen, given, atol=1e-5)
    assert (atlas.tints == 1).all()
    np.testing.assert_allclose(sample_image(atlas.picture, atlas.ground[None])[0], GROUND, atol=1e-6)


def test_faces_without_a_texture_have_a_patch_of_their_colour_or_tints(monkeypatch):
    rng = np.random.default_rng(2)
    colours = rng.random((5, 1, 3)).repeat(3, axis=1).astype(np.float32)
    colours[4] = rng.random((3, 3))  # from corner to corner
    table = table_of(np.full(5, -1), np.zeros((5, 3, 2)), colours)
    for patches, tinted in ((4, [4]), (3, [0, 1, 2, 3, 4])):
        monkeypatch.setattr(module, "_PATCHES", patches)
        atlas = atlas_of(table, [], GROUND)
        assert np.flatnonzero((atlas.tints != 1).any(axis=(1, 2))).tolist() == tinted
        seen = sample_image(atlas.picture, atlas.texels.reshape(-1, 2)).reshape(5, 3, 3)
        np.testing.assert_allclose(seen * atlas.tints, colours, atol=1e-6)


def test_different_pictures_are_far_from_each_other(textures):
    corners = np.zeros((3, 3, 2)) + np.array([[[29.5, 7.5]], [[-0.5, -0.5]], [[-0.5, -0.5]]])
    atlas = atlas_of(table_of(np.arange(3), corners, np.ones((3, 3, 3))), textures, GROUND)
    places = np.vstack([atlas.texels[:, 0], atlas.ground])
    apart = np.abs(places[:, None] - places).max(axis=2)
    assert apart[~np.eye(4, dtype=bool)].min() > 6
