"""Paint that is linear in the picture, beside barycentric weights."""

import numpy as np

from toongeo.render.frames.face_paint import FacePaint
from toongeo.render.raster.affine_weights import affine_weights


def test_values_are_those_at_the_corners_blended_and_textures_multiply_the_colour():
    rng = np.random.default_rng(0)
    points = rng.uniform(0, 500, (30, 2))
    faces = np.arange(30).reshape(10, 3)
    corners = rng.uniform(0, 9, (6, 3, 10)).astype(np.float32)
    texture_of = np.arange(10) % 3 - 1  # of two textures, or none
    textures = tuple(np.full((12, 12, 3), shade, np.float32) for shade in (0.25, [0.5, 1.0, 2.0]))
    paint = FacePaint.of_corners(affine_weights(points, faces)[0], corners, texture_of, textures)

    rows = rng.integers(0, 10, 40_000)  # more than one chunk of each
    weights = rng.dirichlet(np.ones(3), len(rows))
    x, y = np.einsum("kcd,kc->dk", points[faces[rows]], weights).astype(np.float32)
    expected = np.einsum("vck,kc->vk", corners[:, :, rows], weights)
    expected[3:] *= np.array([[1.0, 1, 1], [0.25] * 3, [0.5, 1, 2]])[texture_of[rows] + 1].T
    found = np.full_like(expected, np.nan)
    for some, values in paint.at(rows, x, y):
        found[:, some] = values
    np.testing.assert_allclose(found, expected, atol=0.01)  # texels; float32 over 500 px
