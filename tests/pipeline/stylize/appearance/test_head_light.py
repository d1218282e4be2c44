"""The light of a face is found although something covers a part of it."""

import numpy as np
import pytest

from toongeo.pipeline.stylize.appearance.head_light import _shading_basis, best_light


@pytest.fixture
def lit(rng):
    """Shading basis (k, 9) of a hemisphere that faces the camera, and its luminance (k,) in a light from one side."""
    normals = rng.normal(size=(4000, 3))
    normals[:, 2] = np.abs(normals[:, 2])
    basis = _shading_basis(normals / np.linalg.norm(normals, axis=1, keepdims=True))
    light = np.zeros(9)
    light[[0, 1, 2, 3]] = 1.0, 0.15, 0.2, 0.4
    return basis, basis @ light


def test_bare_skin_gives_the_light_that_falls_on_it(lit):
    """All but what the ridge takes."""
    basis, luminance = lit
    error = np.abs(basis @ best_light(basis, luminance) - luminance)
    assert error.max() < 0.05 * np.median(luminance)


@pytest.mark.parametrize("factor", [0.15, 2.5])
def test_stubble_or_glitter_is_not_taken_for_light(lit, rng, factor):
    """A quarter of the pixels, anywhere: least squares would lay it into the light, and miss by three times as much."""
    basis, luminance = lit
    covered = rng.choice(len(luminance), len(luminance) // 4, replace=False)
    seen = luminance.copy()
    seen[covered] *= factor
    bare = np.setdiff1d(np.arange(len(seen)), covered)
    plain = np.linalg.lstsq(basis, seen, rcond=None)[0]
    off, plainly = (np.abs(basis @ light - luminance)[bare].mean() for light in (best_light(basis, seen), plain))
    assert off < plainly / 3
