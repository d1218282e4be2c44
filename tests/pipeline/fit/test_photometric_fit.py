"""How far the landmarks are off after a fit to the picture."""

from types import SimpleNamespace

import numpy as np
import pytest

from toongeo.pipeline.fit.photometric_fit import _inner_error


@pytest.mark.parametrize("missing", [[], [30], list(range(17, 60))])
def test_the_error_is_that_of_the_inner_points_that_are_there(rng, missing):
    points, off = rng.normal(0, 100, (68, 2)), rng.normal(0, 3, (68, 2))
    fit = SimpleNamespace(vertices=points + off, landmark_vertices=np.arange(68), project=lambda V: V)
    pixels = points.copy()
    pixels[missing] = np.nan
    there = np.setdiff1d(np.arange(17, 68), missing)
    rms, percent = _inner_error(fit, pixels)
    assert rms == pytest.approx(np.sqrt((off[there] ** 2).sum(1).mean()))
    eyes = np.where(np.isfinite(pixels), pixels, points + off)[[36, 45]]
    assert percent == pytest.approx(100 * rms / np.linalg.norm(eyes[0] - eyes[1]))


def test_without_inner_points_there_is_no_error():
    fit = SimpleNamespace(
        vertices=np.arange(136.0).reshape(68, 2), landmark_vertices=np.arange(68), project=lambda V: V
    )
    pixels = np.arange(136.0).reshape(68, 2)
    pixels[17:] = np.nan
    assert np.isnan(_inner_error(fit, pixels)[0])
