import cv2
import numpy as np
import pytest

from toongeo import ClassicalTextureGenerator, TextureGeometry, compose_texture
from toongeo.editing.texture.atlas_raster import AtlasRaster
from toongeo.editing.texture.match_colours import from_lab, match_colours, to_lab
from toongeo.editing.texture.shading_ratio import LEAST, MOST, ShadingRatio
from toongeo.geometry import vertex_normals
from toongeo.render import irradiance

BLINK = {"eyeBlinkLeft": 1.0}


@pytest.fixture(scope="module")
def texture(avatar):
    return cv2.resize(avatar.texture, (256, 256), interpolation=cv2.INTER_AREA)


@pytest.fixture(scope="module")
def generator(avatar, texture):
    return ClassicalTextureGenerator(avatar.face.model, avatar.rig, texture)


def geometry(avatar, weights):
    model = avatar.face.model
    target = avatar.rig.vertices(weights)
    return TextureGeometry(avatar.rig.neutral, target, model.faces, model.uv, model.uv_faces)


def made(avatar, generator, texture, weights):
    source, target = avatar.rig.weights(None), avatar.rig.weights(weights)
    C, A = generator(texture, source, target, geometry(avatar, weights))
    return compose_texture(texture, C, A), A


def on(avatar, name, size):
    model = avatar.face.model
    raster = AtlasRaster(model.faces, model.uv, model.uv_faces, size)
    return raster.image(model.region(name).astype(np.float32)[:, None])[..., 0] > 0.99


def test_the_same_expression_keeps_the_texture(avatar, generator, texture):
    new, A = made(avatar, generator, texture, None)
    skin = on(avatar, "cheek_left", 256) | on(avatar, "forehead", 256)
    assert np.allclose(new[skin], texture[skin], atol=1e-3)
    assert np.median(A[skin]) == 1
    assert A[skin].min() > 0.95  # lips that are a little parted show a little of the inside


def test_a_blink_changes_the_lid_of_its_side_only(avatar, generator, texture):
    new, A = made(avatar, generator, texture, BLINK)
    left, right = (on(avatar, f"eyelid_upper_{side}", 256) for side in ("left", "right"))
    assert A[left].mean() < 0.2
    assert A[right].min() > 0.95
    assert np.abs(new[right] - texture[right]).max() < 4


def test_an_open_mouth_shows_light_teeth_in_a_dark_cavity(avatar, generator, texture):
    new, _ = made(avatar, generator, texture, {"jawOpen": 0.7})
    L = to_lab(new.reshape(-1, 3))[:, 0].reshape(256, 256)
    teeth, cavity = on(avatar, "teeth_upper", 256), on(avatar, "mouth_cavity", 256)
    assert np.median(L[teeth]) > np.median(L[cavity]) + 25


def test_same_input_same_output(avatar, generator, texture):
    first, second = (made(avatar, generator, texture, {"mouthSmileLeft": 0.8})[0] for _ in range(2))
    assert (first == second).all()


def test_bad_textures(avatar, generator, texture):
    with pytest.raises(ValueError, match="texture: expected 256 x 256 texels"):
        generator(np.zeros((128, 128, 3), np.uint8), None, None, geometry(avatar, None))
    with pytest.raises(ValueError, match=r"texture: expected \(S, S, 3\) uint8"):
        ClassicalTextureGenerator(avatar.face.model, avatar.rig, texture.astype(float))


def test_matched_colours_have_the_wanted_mean_and_contrast(rng):
    colours = rng.uniform(100, 150, (200, 3))
    before, after = to_lab(colours), to_lab(match_colours(colours, np.array([60.0, 5.0, -5.0]), 0.5))
    assert np.allclose(after.mean(0), [60, 5, -5], atol=0.1)
    assert np.allclose(after.std(0), 0.5 * before.std(0), atol=0.1)
    assert np.allclose(from_lab(before), colours, atol=0.6)


def test_ratios_are_those_of_the_light_that_shaded_the_face(model):
    """Lightness rendered with a known light: the ratio for a turned head is that light's."""
    light = np.zeros((9, 3))
    light[0], light[2], light[3] = 3.0, 0.5, 0.5
    turn = np.array([[np.cos(0.2), 0, np.sin(0.2)], [0, 1, 0], [-np.sin(0.2), 0, np.cos(0.2)]])
    old, new = (irradiance(vertex_normals(V, model.faces), light)[:, 0] for V in (model.mean, model.mean @ turn.T))
    skin = model.region("face")
    ratio = ShadingRatio(old, model.mean, model.faces, skin)
    found = ratio(model.mean, model.mean @ turn.T) ** 2.2
    true = np.clip(new / old, LEAST, MOST)
    assert np.abs(found - true)[skin].mean() < 0.5 * np.abs(1 - true)[skin].mean()
    assert np.allclose(ratio(model.mean, model.mean), 1)


def test_flat_colours_are_not_shaded(model):
    ratio = ShadingRatio(np.full(len(model.mean), 0.5), model.mean, model.faces, model.region("face"))
    assert np.allclose(ratio(model.mean, model.mean * [1, 2, 0.5]), 1, atol=0.01)
