"""Hair, light and checks of a bake that is told more than the picture."""

import dataclasses

import cv2
import numpy as np
import pytest

from toongeo.pipeline import bake_texture
from toongeo.pipeline.texture.bake_texture import _atlas_fragments
from toongeo.pipeline.texture.vertex_colours import vertex_colours
from toongeo.protocols import FaceLabel, FaceParse

HAIR, SKIN = (60, 30, 10), (220, 170, 140)


@pytest.fixture(scope="module")
def face(aligned):
    return aligned("moustache_man")


def texels_of(face, name, atlas):
    fragments = _atlas_fragments(face.model, len(atlas))
    return atlas[fragments.mask & face.region(name)[face.faces].all(1)[fragments.face_ids]].astype(float)


def painted(face, shape, hair):
    """A face of one skin colour with hair above the brows' highest point, as picture and parse."""
    labels = np.full(shape[:2], FaceLabel.SKIN, np.uint8)
    if hair:
        brow = face.project(face.vertices[face.landmark_vertices])[17:27, 1].min()
        labels[: int(brow) - 25] = FaceLabel.HAIR
    img = np.where((labels == FaceLabel.HAIR)[..., None], np.uint8(HAIR), np.uint8(SKIN))
    return img, FaceParse(labels, np.ones(labels.shape))


def test_the_scalp_takes_the_colour_of_the_hair(face, cartoon):
    img, parse = painted(face, cartoon("moustache_man")[0].shape, hair=True)
    atlas = bake_texture(img, face, size=256, parse=parse)
    np.testing.assert_allclose(np.median(texels_of(face, "scalp", atlas), axis=0), HAIR, atol=2)
    for part in ("cheek_left", "nose", "neck"):
        np.testing.assert_allclose(np.median(texels_of(face, part, atlas), axis=0), SKIN, atol=2)


def test_a_strand_over_the_side_of_a_cheek_is_not_painted_on_it(face, cartoon):
    img, parse = painted(face, cartoon("moustache_man")[0].shape, hair=True)
    jaw, nose = (face.project(face.vertices[face.landmark_vertices])[[4, 33]]).astype(int)
    x = int(jaw[0] + 0.15 * (nose[0] - jaw[0]))
    for layer, value in ((img, HAIR), (parse.labels, FaceLabel.HAIR)):
        layer.setflags(write=True)
        layer[: jaw[1], x - 6 : x + 7] = value
    atlas = bake_texture(img, face, size=256, parse=parse)
    cheek = np.vstack([texels_of(face, f"cheek_{side}", atlas) for side in ("left", "right")])
    assert np.abs(cheek - SKIN).max(1).mean() < 2


def test_without_hair_in_the_parse_the_head_stays_bald(face, cartoon):
    img, parse = painted(face, cartoon("moustache_man")[0].shape, hair=False)
    atlas = bake_texture(img, face, size=256, parse=parse)
    np.testing.assert_allclose(
        texels_of(face, "scalp", atlas), np.tile(SKIN, (len(texels_of(face, "scalp", atlas)), 1)), atol=1
    )


def test_delight_undoes_ambient_light(face, cartoon):
    """Half the light on a face of one linear albedo: the texture is that albedo, not what the picture shows."""
    light = np.zeros((9, 3))
    light[0] = 0.5 * np.sqrt(4 * np.pi)
    lit = dataclasses.replace(face, fit=dataclasses.replace(face.fit, light=light, albedo=np.zeros(9)))
    shown = np.array([150, 110, 90])
    img = np.broadcast_to(shown.astype(np.uint8), cartoon("moustache_man")[0].shape).copy()
    linear = np.where(shown / 255 <= 0.04045, shown / 255 / 12.92, ((shown / 255 + 0.055) / 1.055) ** 2.4)
    doubled = 2 * linear
    expected = 255 * (1.055 * doubled ** (1 / 2.4) - 0.055)
    atlas = bake_texture(img, lit, size=256, delight=True)
    np.testing.assert_allclose(np.median(texels_of(face, "face", atlas), axis=0), expected, atol=1)


def test_bad_arguments_are_named(face, cartoon):
    img = cartoon("moustache_man")[0]
    small = cv2.resize(img, None, fx=0.5, fy=0.5)
    with pytest.raises(ValueError, match=r"delight: expected a fit with light"):
        bake_texture(img, face, delight=True)
    with pytest.raises(ValueError, match=r"parse: expected labels of the picture's shape"):
        bake_texture(img, face, parse=FaceParse(np.ones(small.shape[:2], np.uint8), np.ones(small.shape[:2])))


def test_a_gleaming_forehead_is_the_one_that_is_drawn(face, cartoon):
    """Far from the skin's colour, but the parse calls it skin; what it does not call so is replaced all the same."""
    img, parse = painted(face, cartoon("moustache_man")[0].shape, hair=False)
    brow = face.project(face.vertices[face.landmark_vertices])[17:27, 1].min()
    gleam = np.array([250, 235, 225], np.uint8)
    img[: int(brow) - 5] = gleam
    drawn = bake_texture(img, face, size=256, parse=parse)
    labels = parse.labels.copy()
    labels[: int(brow) - 5] = FaceLabel.BACKGROUND
    filled = bake_texture(img, face, size=256, parse=dataclasses.replace(parse, labels=labels))
    above = face.region("forehead") & (face.project(face.vertices)[:, 1] < brow - 15) & (face.normals[:, 2] > 0.7)
    at = {name: vertex_colours(face.model, atlas)[above] for name, atlas in (("drawn", drawn), ("filled", filled))}
    assert above.sum() > 20
    assert np.abs(np.median(at["drawn"], axis=0) - gleam).max() < 6
    assert np.abs(np.median(at["filled"], axis=0) - SKIN).max() < 6
