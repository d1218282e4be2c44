"""An avatar as meshes of trimesh: where its own vertices are, in every expression."""

import numpy as np
import pytest

from toongeo.avatar.scene import head_parts

WEIGHTS = {"jawOpen": 0.7, "eyeBlinkLeft": 1.0, "eyeLookOutLeft": 1.0, "eyeLookInRight": 1.0}


@pytest.mark.parametrize("weights", [None, WEIGHTS], ids=["neutral", "expression"])
@pytest.mark.parametrize("crop", ["head", "face"])
def test_every_corner_is_where_the_avatar_has_it(avatar, weights, crop):
    bare = avatar.to_trimesh(weights, crop=crop, textured=False)
    textured = avatar.to_trimesh(weights, crop=crop)
    model, vertices = avatar.face.model, avatar.vertices(weights)
    expected = {name: vertices[model.faces[kept]] for name, kept in head_parts(model, crop).items()}
    for side, name in enumerate(("eye_left", "eye_right")):
        expected[name] = avatar.eye_vertices(side, weights)[avatar.eyes.templates[side].faces]
    assert set(bare.geometry) == set(textured.geometry) == set(expected)
    for name, corners in expected.items():
        for scene in (bare, textured):
            mesh = scene.geometry[name]
            np.testing.assert_array_equal(mesh.vertices[mesh.faces], corners)
        np.testing.assert_array_equal(
            np.array(textured.geometry[name].visual.material.baseColorTexture), avatar.texture
        )
    assert bare.units == textured.units == "millimeters"
    moved = vertices - avatar.vertices()
    assert (np.abs(moved).max() > 5) == (weights is not None)


def test_bad_weights_and_crops_are_refused(avatar):
    with pytest.raises(ValueError, match="jawOpe"):
        avatar.to_trimesh({"jawOpe": 1.0})
    with pytest.raises(ValueError, match="crop: expected"):
        avatar.to_trimesh(crop="nose")
