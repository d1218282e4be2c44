"""Corners of faces as vertices."""

import numpy as np

from toongeo.render.frames.atlas import Atlas
from toongeo.render.frames.drawn_vertices import drawn_vertices


def test_corners_stay_and_vertices_are_several_only_where_their_places_or_tints_are():
    rng = np.random.default_rng(0)
    faces, order = rng.integers(0, 9, (40, 3)), rng.permutation(40)
    place = rng.integers(0, 2, (40, 3))
    texels = np.stack([faces + 0.25 * place, faces], axis=2).astype(np.float32)
    tints = np.ones((40, 3, 3), np.float32)
    tints[7] = 0.5
    nowhere = np.zeros(2, np.float32)
    drawn = drawn_vertices(faces, Atlas(np.zeros((1, 1, 3), np.float32), texels, tints, nowhere), order)
    assert drawn.faces.dtype == np.int32
    np.testing.assert_array_equal(drawn.origin[drawn.faces], faces[order])
    np.testing.assert_array_equal(drawn.texels[drawn.faces], texels[order])
    np.testing.assert_array_equal(drawn.tints[drawn.faces], tints[order])
    different = {
        (*corner, *place, *tint)
        for corner, place, tint in zip(faces.reshape(-1, 1), texels.reshape(-1, 2), tints.reshape(-1, 3), strict=True)
    }
    assert len(drawn.origin) == len(different)
