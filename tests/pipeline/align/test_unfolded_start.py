from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import CARTOONS
from toongeo.geometry import self_intersections
from toongeo.model.anatomy.visible_contour import visible_contour
from toongeo.pipeline import align_face, fit_3dmm, neutral_face
from toongeo.pipeline.align.unfolded_start import unfolded_start
from toongeo.render import ScaledOrthographicCamera


def crossings(model, V):
    front = model.faces[model.region("face")[model.faces].all(1)]
    return len(np.unique(self_intersections(V, front)))


@pytest.fixture(scope="module")
def wide(model):
    """Landmarks of an open mouth that is more than twice as wide as the model's."""
    expression = np.zeros(len(model.expression))
    expression[model.expression_names.index("jawOpen")] = 1.0
    V = model.vertices(np.random.default_rng(0).normal(0, 0.5, len(model.identity)), expression)
    away = V - V[model.landmarks[48:]].mean(0)
    near = np.exp(-((np.linalg.norm(away / [2.3, 1.2, 1], axis=1) / 30) ** 2))
    V = V + near[:, None] * away * [1.3, 0.2, 0]
    camera = ScaledOrthographicCamera.look(size=512)
    return camera.project(V[visible_contour(model, camera, V, model.landmarks)])


def test_a_mouth_as_wide_as_the_face_begins_and_ends_without_a_fold(model, wide):
    fit = fit_3dmm(None, wide)
    assert crossings(model, fit.vertices) > 10  # else this shows nothing
    assert crossings(model, unfolded_start(fit).vertices) <= 5
    face = align_face(fit, wide)
    assert crossings(model, face.vertices) <= 5
    assert face.report.max_px < 0.1
    rest = neutral_face(face)  # takes out what went in; taking out all that was fitted leaves dents for folds
    dented = neutral_face(replace(face, fit=fit))
    assert crossings(model, rest.vertices) <= min(10, crossings(model, dented.vertices) / 2)
    gap = [np.linalg.norm(np.subtract(*V[model.landmarks[[62, 66]]])) for V in (face.vertices, rest.vertices)]
    assert gap[1] < 0.1 * gap[0]


def test_sound_faces_are_left_as_they_are(fits):
    for name in CARTOONS:
        assert unfolded_start(fits(name)) is fits(name), name
