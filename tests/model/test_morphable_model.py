from dataclasses import replace

import numpy as np
import pytest

from toongeo.geometry import catmull_clark
from toongeo.model import MorphableModel, data_path, default_model
from toongeo.model.artist_model import artist_model


def test_vertices_are_linear(model, rng):
    a, b = rng.normal(size=81), rng.random(64)
    expected = model.mean + np.tensordot(a, model.identity, 1) + np.tensordot(b, model.expression, 1)
    np.testing.assert_allclose(model.vertices(a, b), expected, atol=1e-3)
    np.testing.assert_array_equal(model.vertices(), model.mean)


def test_refining_the_modes_refines_the_face(rng):
    """Catmull-Clark of a posed cage is the refined mean plus the refined modes."""
    with np.load(data_path("data_templates/head.npz"), allow_pickle=False) as z:
        cage, quads, modes = z["mean"].astype(float), z["quads"].astype(int), z["identity"].astype(float)
    a = rng.normal(size=80)
    S, _ = catmull_clark(quads, len(cage))
    np.testing.assert_allclose(artist_model().vertices(a), S @ (cage + np.tensordot(a, modes, 1)), atol=1e-3)


def test_the_model_is_loaded_once_and_read_only(model):
    assert default_model() is model
    for array in (
        model.mean,
        model.identity,
        model.regions["face"],
        model.contour_lines[0],
        model.eyes[0].uv,
    ):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_uv_faces_follow_the_faces(model):
    """A triangle and its twin in the atlas have the same corners: no vertex sits at two places of one island edge."""
    assert model.uv_faces.shape == model.faces.shape
    pairs = np.unique(np.column_stack([model.uv_faces.ravel(), model.faces.ravel()]), axis=0)
    assert len(np.unique(pairs[:, 0])) == len(pairs)  # a texture point belongs to one vertex


def test_bad_arguments_are_named(model):
    with pytest.raises(ValueError, match=r"identity: expected shape \(81,\), got \(3,\)"):
        model.vertices(np.zeros(3))
    with pytest.raises(ValueError, match=r"expression: expected shape \(64,\)"):
        model.vertices(None, np.zeros(46))
    with pytest.raises(ValueError, match="name: no region 'beard'; known: .*brow_left"):
        model.region("beard")
    with pytest.raises(ValueError, match="name: no expression 'smile_left'; did you mean"):
        model.expression_index("smile_left")
    assert model.expression_names[model.expression_index("jawOpen")] == "jawOpen"


def bare(model, **given):
    return MorphableModel(
        **{"mean": model.mean, "faces": model.faces, "identity": model.identity, "landmarks": model.landmarks} | given
    )


def test_a_model_of_bare_skin_has_nothing_else(model):
    skin = bare(model)
    for name in ("quads", "uv", "uv_faces", "eyes", "albedo", "expression", "mouth", "jawOpen", "ears"):
        assert model.has(name) and not skin.has(name), name
    assert model.has("eyes", "mouth") and not replace(model, eyes=()).has("eyes", "mouth")
    assert skin.region("face").all() and skin.region("skin").all() and not skin.region("ears").any()
    np.testing.assert_array_equal(skin.mirror, model.mirror)  # of a symmetric mesh, from its shape alone
    assert [line.tolist() for line in skin.contour_lines] == [[v] for v in model.landmarks[:17]]
    assert np.ptp(skin.albedo_mean) == 0 and skin.albedo_mean.shape == model.mean.shape
    np.testing.assert_array_equal(skin.vertices(expression=np.zeros(0)), model.mean)
    with pytest.raises(ValueError, match=r"expression: expected shape \(0,\), got \(1,\)"):
        skin.vertices(expression=[1.0])


def test_skin_is_what_does_not_lie_behind_it(model):
    inner = {name: model.regions[name] for name in ("teeth_upper", "neck")}
    skin = bare(model, regions=inner).region("skin")
    np.testing.assert_array_equal(skin, ~(inner["teeth_upper"] | inner["neck"]))


def test_landmarks_are_vertices(model):
    with pytest.raises(ValueError, match=r"landmarks: expected vertices in 0..\d+, got -1 to"):
        bare(model, landmarks=np.r_[-1, model.landmarks[1:]])
