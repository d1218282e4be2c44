"""Every function that takes landmarks takes them in the schemes of `ibug_landmarks`, with the same result."""

from functools import lru_cache

import numpy as np
import pytest

from toongeo.caricature import fit_caricature
from toongeo.caricature.baselines.bilinear_model import BilinearModel, bilinear_fit
from toongeo.caricature.baselines.linear_fit import linear_fit
from toongeo.caricature.blendshapes.sparse_expression import sparse_expression
from toongeo.driving import LandmarkDriver
from toongeo.model import default_model
from toongeo.model.ibug68 import INNER
from toongeo.model.mediapipe478 import VERTICES
from toongeo.pipeline import align_face, find_irises, fit_3dmm, ibug_landmarks, parse_face, snap_eyes
from toongeo.pipeline.fit.adjust_coefficients import adjust_coefficients
from toongeo.pipeline.fit.photometric_fit import photometric_fit


@pytest.fixture(scope="module")
def case(cartoon):
    """Picture, 68 points, and the same in a mesh of 478."""
    img, landmarks = cartoon("moustache_man")
    mesh = np.random.default_rng(0).uniform(0, 100, (478, 2))
    mesh[VERTICES] = landmarks
    fit = fit_3dmm(img, landmarks)
    return img, landmarks, mesh, fit, parse_face(img, landmarks, fit)


@lru_cache
def bilinear(model):
    return BilinearModel.from_model(model, np.random.default_rng(0), identities=20)


def functions(img, fit, parse):
    model = default_model()
    return {
        "fit_3dmm": lambda x, **s: fit_3dmm(img, x, **s).vertices,
        "parse_face": lambda x, **s: parse_face(img, x, fit, **s).labels,
        "snap_eyes": lambda x, **s: snap_eyes(x, parse, **s),
        "align_face": lambda x, **s: align_face(fit, x, **s).vertices,
        "find_irises": lambda x, **s: np.array([iris.centre for iris in find_irises(img, x, **s)]),
        "adjust_coefficients": lambda x, **s: (
            adjust_coefficients(fit, x, "expression", max_evaluations=20, **s).vertices
        ),
        "photometric_fit": lambda x, **s: photometric_fit(img, fit, x, **s).vertices,
        "fit_caricature": lambda x, **s: fit_caricature(img, x, iterations=1, **s).vertices,
        "linear_fit": lambda x, **s: linear_fit(x, model, model.mean, model.identity, 1.0, **s).vertices,
        "bilinear_fit": lambda x, **s: bilinear_fit(x, model, bilinear(model), **s).vertices,
        "sparse_expression": lambda x, **s: sparse_expression(fit, x, **s).vertices,
        "LandmarkDriver": lambda x, **s: LandmarkDriver(x, **s).frames(np.stack([x, x + 1])),
    }


@pytest.mark.parametrize("name", functions(None, None, None))
def test_a_face_mesh_is_its_68_points(case, name):
    img, landmarks, mesh, fit, parse = case
    call = functions(img, fit, parse)[name]
    np.testing.assert_array_equal(call(mesh, scheme="mediapipe478"), call(landmarks))


@pytest.mark.parametrize("name", functions(None, None, None))
def test_another_number_of_points_is_refused_by_name(case, name):
    img, landmarks, _, fit, parse = case
    with pytest.raises(ValueError, match=r"landmarks: expected shape \(51, 2\) px for scheme 'ibug51', got \(68, 2\)"):
        functions(img, fit, parse)[name](landmarks, scheme="ibug51")


def test_a_table_needs_a_model():
    with pytest.raises(ValueError, match="scheme: expected a name here, got ndarray: a table is for fit_3dmm and"):
        ibug_landmarks(np.zeros((68, 2)), np.arange(68))


@pytest.mark.parametrize("bad", [np.inf, np.nan])
def test_what_a_scheme_gives_is_checked(bad):
    points = np.zeros((51, 2))
    points[3, 1] = bad
    with pytest.raises(ValueError, match=r"landmarks: .*row 20"):
        ibug_landmarks(points, "ibug51")
    assert np.isnan(ibug_landmarks(np.zeros((51, 2)), "ibug51")[:17]).all() and len(INNER) == 51
