"""Tests of the numbers that the trees see, and of the trees that travel with the library."""

import numpy as np
import pytest

from toongeo import fit_3dmm
from toongeo.colour.cielab import cielab
from toongeo.model.ibug68 import MIRROR
from toongeo.pipeline.parse.hair.appearance import appearance
from toongeo.pipeline.parse.hair.context import context
from toongeo.pipeline.parse.hair.hair_model import hair_model
from toongeo.pipeline.parse.hair.hair_view import hair_view
from toongeo.pipeline.parse.hair.head_zones import head_zones
from toongeo.pipeline.parse.hair.superpixels import Superpixels, superpixels

SAMPLED = ("away", "share", "plain", "strange")  # by tones that k-means finds in pixels in their order


@pytest.fixture(scope="module")
def seen(cartoon):
    """Zones and patches of a drawing."""
    img, landmarks = cartoon("beethoven")
    fit = fit_3dmm(None, landmarks)
    view = hair_view(img, fit)
    return head_zones(view, landmarks, fit), superpixels(cielab(view.pixels))


@pytest.fixture(scope="module")
def mirrored(seen):
    """Zones and patches of the mirrored view, patch by patch the same."""
    zones, patches = seen
    flipped = {
        name: np.ascontiguousarray(value[:, ::-1]) if isinstance(value, np.ndarray) and value.ndim == 2 else value
        for name, value in vars(zones).items()
    }
    width = patches.labels.shape[1]
    flipped |= {"across": -flipped["across"], "chin": [width - 1, 0] + zones.chin * [-1, 1]}
    labels, lab = patches.labels[:, ::-1], np.ascontiguousarray(patches.lab[:, ::-1])
    return type(zones)(**flipped), Superpixels(np.ascontiguousarray(labels), lab)


def test_a_mirrored_view_gives_the_same_numbers(seen, mirrored):
    here, there = appearance(*seen), appearance(*mirrored)
    assert list(here) == list(there)
    for name, numbers in here.items():
        if not name.startswith(SAMPLED):
            np.testing.assert_allclose(there[name], numbers, atol=5e-3, err_msg=name)


def test_a_mirrored_view_has_the_same_surroundings(seen, mirrored, rng):
    guess = rng.dirichlet([1, 1, 1], len(seen[1].area)).astype(np.float32)
    here, there = context(*seen, guess), context(*mirrored, guess)
    for name, numbers in here.items():
        tolerance = 0.5 if name.startswith("mirrored") else 2e-3  # interpolated, and cut off at the border
        np.testing.assert_allclose(np.median(np.abs(there[name] - numbers)), 0, atol=tolerance, err_msg=name)


def test_zones_are_where_the_landmarks_are(cartoon):
    img, landmarks = cartoon("beethoven")
    fit = fit_3dmm(None, landmarks)
    view = hair_view(img, fit)
    zones = head_zones(view, landmarks, fit)
    x, y = np.rint(view.place(landmarks)).astype(int).T
    np.testing.assert_allclose(zones.up[y[8], x[8]], -1, atol=0.02)
    assert abs(zones.up[y[17:27], x[17:27]].mean()) < 0.02
    assert zones.core[y[30], x[30]] and zones.hull[y[27:36], x[27:36]].all()
    assert not zones.plain[y[36:48], x[36:48]].any() and zones.brow[y[18:26], x[18:26]].all()
    mirror = landmarks[MIRROR] * [-1, 1] + [img.shape[1] - 1, 0]
    fit = fit_3dmm(None, mirror)
    view = hair_view(np.ascontiguousarray(img[:, ::-1]), fit)
    other = head_zones(view, mirror, fit)
    assert (other.hull[:, ::-1] == zones.hull).mean() > 0.99


def test_the_trees_that_travel_fit_the_numbers(seen):
    model = hair_model()
    zones, patches = seen
    guess, answer = model(zones, patches)
    columns = len(appearance(zones, patches))
    assert model.first.features.max() < columns
    assert model.second.features.max() < columns + len(context(zones, patches, guess))
    for chances in (guess, answer):
        np.testing.assert_allclose(chances.sum(axis=1), 1, atol=1e-5)
    crown = patches.mean(zones.crown) > 0.9
    face = patches.mean(zones.plain) > 0.9
    assert answer[crown, 1].mean() > 0.5 > 0.2 > answer[face, 1].mean()


def test_numbers_of_place_do_not_change_with_the_colours(seen):
    zones, patches = seen
    inverted = Superpixels(patches.labels, patches.lab * np.float32([-1, 1, 1]) + np.float32([100, 0, 0]))
    here, there = appearance(zones, patches), appearance(zones, inverted)
    for name in ("aside", "up", "off skull", "off hull", "skull", "crown", "ears", "brow", "border"):
        np.testing.assert_array_equal(there[name], here[name])
