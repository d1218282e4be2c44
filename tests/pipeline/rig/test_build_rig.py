import numpy as np
import pytest

from toongeo.pipeline import build_rig


@pytest.fixture(scope="module")
def rig(avatar):
    return avatar.rig


def test_on_the_mean_face_the_rig_is_the_template(model, aligned):
    """Identity transfer: with the template's own mean as the target every expression comes back."""
    mean = _with_vertices(aligned("astronaut"), model.mean)
    rig = build_rig(mean)
    np.testing.assert_allclose(rig.deltas, model.expression[:46], atol=0.1)  # what is pinned moves less


def _with_vertices(face, vertices):
    import dataclasses

    return dataclasses.replace(face, vertices=vertices)


def test_vertices_are_linear_in_the_weights(rig, rng):
    a, b = rng.random((2, 46))
    middle = (rig.vertices(a) + rig.vertices(b)) / 2
    np.testing.assert_allclose(rig.vertices((a + b) / 2), middle, atol=1e-4)
    np.testing.assert_array_equal(rig.vertices(), rig.neutral)


def test_the_skull_does_not_drift(rig, model):
    still = np.abs(model.expression[:46]).max(axis=(0, 2)) < 0.05
    assert still.sum() > 1000
    assert np.abs(rig.deltas[:, still]).max() < 0.06


def test_names_are_those_of_the_model(rig, model):
    assert rig.names == model.expression_names[:46]
    assert rig.deltas.shape == (46, len(model.mean), 3)


def test_where_the_template_is_still_in_an_expression_so_is_the_face(transferred, model):
    """Of each of the 46, on a face drawn unlike the template, whose gradients add up to drift."""
    rig, motion = transferred("manga_girl"), np.linalg.norm(model.expression[:46], axis=2)
    for name, moved, template in zip(rig.names, np.linalg.norm(rig.deltas, axis=2), motion, strict=True):
        still = template < 0.002 * template.max()
        assert (moved[still] <= 1.5 * template[still] + 1e-6).all(), name  # as much as the template, in its size
    jaw = rig.names.index("jawOpen")
    assert np.linalg.norm(rig.deltas[jaw], axis=1).max() > 5


def test_an_opening_jaw_leaves_the_lids_alone(avatars, model):
    """After all contacts were fitted, too; of the height of the eye."""
    rig = avatars("astronaut").rig
    jaw = rig.deltas[rig.names.index("jawOpen")]
    for upper, lower, lids in (((37, 38), (41, 40), range(36, 42)), ((43, 44), (47, 46), range(42, 48))):
        edges = (rig.neutral[model.landmarks[list(edge)]] for edge in (upper, lower))
        height = np.linalg.norm(np.subtract(*edges), axis=1).mean()
        assert np.linalg.norm(jaw[model.landmarks[list(lids)]], axis=1).max() <= 0.05 * height
