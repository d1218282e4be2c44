import sys

import numpy as np
import pytest

from toongeo.avatar.make_avatar import make_avatar
from toongeo.caricature.blendshapes.caricature_rig import caricature_rig
from toongeo.caricature.blendshapes.initial_blendshapes import initial_blendshapes, source_offsets
from toongeo.caricature.blendshapes.optimize_blendshapes import displacement_masks, expression_similarities
from toongeo.caricature.fit_caricature import fit_caricature
from toongeo.pipeline.align.align_face import align_face
from toongeo.pipeline.fit.fit_3dmm import fit_3dmm

NAME = "bad_guy"

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def drawn(cartoon):
    return cartoon(NAME)[1]


@pytest.fixture(scope="module")
def initial(drawn, face_space):
    return initial_blendshapes(fit_caricature(None, drawn, space=face_space), drawn)


@pytest.fixture(scope="module")
def face(drawn):
    return align_face(fit_3dmm(None, drawn), drawn)


@pytest.fixture(scope="module")
def rig(face, drawn, initial):
    """With the initial shapes that are there already; that it makes the same ones is tested below."""
    module = sys.modules[caricature_rig.__module__]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "fit_caricature", lambda *_, **__: initial.source)
        patch.setattr(module, "initial_blendshapes", lambda *_, **__: initial)
        return caricature_rig(face, drawn)


def normal_shapes(face_space):
    model = face_space.model
    return model.expression[: model.n_named, face_space.vertices].astype(float)


def test_every_shape_meets_its_landmarks(initial, face_space):
    """With the camera of the source."""
    source = initial.source
    for shape, at, target in zip(initial.vertices, initial.landmark_vertices, initial.landmarks, strict=True):
        seen = source.project(shape[face_space.rows(at)]) - source_offsets(source, at)
        off = np.linalg.norm(seen - target, axis=1) / source.camera.scale
        assert np.sqrt((off**2).mean()) < 0.3  # mm


def test_the_drawing_is_its_neutral_face_with_its_own_expression(initial, drawn):
    """Exchanging the expression of the normal face for its own would give the landmarks back."""
    model = initial.normal.model
    moved = initial.landmarks[1:] - initial.landmarks[0]
    own = initial.normal.expression[: model.n_named]
    off = initial.landmarks[0] + np.tensordot(own, moved, 1) - drawn
    assert np.linalg.norm(off, axis=1).mean() < 0.03 * np.linalg.norm(drawn[36] - drawn[45])


def test_the_pose_of_the_rig_is_the_face_of_the_picture(rig, face):
    np.testing.assert_allclose(rig.vertices(rig.pose), face.vertices, atol=1e-3)
    assert rig.pose.min() >= 0 and rig.pose.max() <= 1
    assert rig.deltas.shape == (46, len(face.vertices), 3) and rig.deltas.dtype == np.float32


def test_a_blink_moves_the_eye_alone(rig, face):
    model = face.model
    eye = np.any(
        [model.region(name) for name in ("eye_left", "eyelid_upper_left", "eyelid_lower_left", "socket_left")], axis=0
    )
    motion = np.linalg.norm(rig.deltas[rig.names.index("eyeBlinkLeft")], axis=1)
    size = np.ptp(face.vertices[model.region("face")], axis=0).max()
    assert motion[~eye].max() < 0.005 * size < motion[eye].max()


def test_what_is_still_in_the_normal_face_is_still(rig, face_space):
    masks = displacement_masks(normal_shapes(face_space))
    motion = np.linalg.norm(rig.deltas[:, face_space.vertices], axis=2)
    acting = np.flatnonzero(masks.max(axis=1) > 0)
    shares = [motion[k][masks[k] < 0.05].mean() / motion[k][masks[k] >= 0.05].mean() for k in acting]
    assert np.mean(shares) < 0.1


def test_expressions_resemble_each_other_as_those_of_the_normal_face(rig, initial, face_space):
    normal = normal_shapes(face_space)
    wanted = expression_similarities(normal)

    def deviation(D):
        return np.linalg.norm(expression_similarities(D) - np.where(np.eye(46), 1.0, wanted))

    optimized = rig.deltas[:, face_space.vertices].astype(float)
    assert deviation(optimized) < 0.5 * deviation(initial.vertices[1:] - initial.vertices[0])


def test_an_avatar_has_it(cartoon, face, rig):
    """The same input gives the same rig: that of its face, but for what is done about lips, lids, eyes and skull."""
    img, landmarks = cartoon(NAME)
    again = caricature_rig(face, landmarks)
    np.testing.assert_array_equal(again.deltas, rig.deltas)
    avatar = make_avatar(img, landmarks, rig="caricature", texture_size=64)
    chin = avatar.fit.landmark_vertices[8]
    np.testing.assert_allclose(avatar.rig.deltas[:, chin], again.deltas[:, chin], atol=0.3)
    assert avatar.names == avatar.fit.model.expression_names[:46]


def test_an_unknown_rig_is_refused(cartoon):
    with pytest.raises(ValueError, match="rig: expected 'transfer' or 'caricature', got 'both'"):
        make_avatar(*cartoon(NAME), rig="both")


class Broken:
    def __init__(self, normal, back):
        self.normal, self.back = normal, back

    def to_normal(self, landmarks):
        return self.normal, None

    def to_caricature(self, normal, context):
        return self.back


def test_a_mapper_that_gives_nonsense_is_refused(initial, drawn):
    source = initial.source
    with pytest.raises(ValueError, match=r"mapper: expected to_normal to give \(68, 2\) finite numbers"):
        initial_blendshapes(source, drawn, mapper=Broken(drawn[:5], drawn))
    with pytest.raises(ValueError, match=r"mapper: expected to_caricature to give \(68, 2\) finite numbers"):
        initial_blendshapes(source, drawn, mapper=Broken(drawn, np.full((68, 2), np.nan)))


def test_bad_landmarks_are_refused(face, initial, drawn):
    with pytest.raises(ValueError, match="landmarks: expected 68 points in iBUG order"):
        initial_blendshapes(initial.source, drawn[:10])
    with pytest.raises(ValueError, match="landmarks: expected 68 points in iBUG order"):
        caricature_rig(face, drawn[:10])
