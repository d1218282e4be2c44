import dataclasses

import numpy as np
import pytest

from toongeo.caricature.exaggerate import exaggerate
from toongeo.caricature.space.face_space import FaceSpace
from toongeo.pipeline import fit_3dmm
from toongeo.render import ScaledOrthographicCamera


@pytest.fixture(scope="module")
def fit(cartoon):
    return fit_3dmm(None, cartoon("moustache_man")[1])


def test_nothing_added_gives_the_face_back(fit, face_space):
    same = exaggerate(fit, 0.0, space=face_space)
    np.testing.assert_allclose(same.vertices[face_space.vertices], fit.vertices[face_space.vertices], atol=1e-9)
    assert same.camera is fit.camera
    np.testing.assert_array_equal(same.landmark_vertices, fit.landmark_vertices)


def test_what_differs_from_the_mean_grows(fit, face_space):
    """In the direction in which the identity differs, and by about as much as is asked for."""
    model = fit.model
    face = model.region("face")
    differs = (model.vertices(fit.identity) - model.mean)[face]
    differs -= differs.mean(0)
    for amount in (-0.5, 0.5, 1.0):
        moved = (exaggerate(fit, amount, space=face_space).vertices - fit.vertices)[face]
        moved -= moved.mean(0)
        assert 0.7 < (moved * differs).sum() / (differs**2).sum() / amount < 1.3


def test_the_mean_face_has_nothing_to_exaggerate(face_space):
    model = face_space.model
    camera = ScaledOrthographicCamera.look(size=600)
    fit = fit_3dmm(None, camera.project(model.mean[model.landmarks]))
    moved = exaggerate(fit, 1.0, space=face_space).vertices - fit.vertices
    assert np.sqrt((moved[model.region("face")] ** 2).sum(1).mean()) < 3.0


def test_bad_input_is_refused(fit, face_space):
    with pytest.raises(ValueError, match="amount: expected a finite number, got inf"):
        exaggerate(fit, np.inf, space=face_space)
    other = FaceSpace(dataclasses.replace(face_space.model), face_space.space, face_space.vertices)
    with pytest.raises(ValueError, match="space: expected one of the model of the fit"):
        exaggerate(fit, 1.0, space=other)
