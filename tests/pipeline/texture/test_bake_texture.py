import dataclasses

import cv2
import numpy as np
import pytest

from toongeo.model.ibug68 import MIRROR
from toongeo.pipeline import bake_texture
from toongeo.pipeline.rig.rig import Rig
from toongeo.pipeline.texture.bake_texture import _atlas_fragments
from toongeo.pipeline.texture.face_picture import EYE_LEFT, MAX_SIDE, OPENINGS, face_picture, opening_mask
from toongeo.render import ScaledOrthographicCamera, interpolate, rasterize, sample_image, uv_to_px


@pytest.fixture(scope="module")
def face(aligned):
    return aligned("moustache_man")


@pytest.fixture(scope="module")
def img(cartoon):
    return cartoon("moustache_man")[0]


def test_a_picture_of_one_colour_gives_a_skin_of_that_colour(face, img):
    atlas = bake_texture(np.full_like(img, (200, 150, 120)), face, size=256)
    skin = face.region("skin") | face.region("neck")
    fragments = _atlas_fragments(face.model, 256)
    texels = fragments.mask & skin[face.faces].all(1)[fragments.face_ids]
    assert texels.sum() > 0.4 * 256**2
    np.testing.assert_allclose(atlas[texels], np.tile([200, 150, 120], (texels.sum(), 1)), atol=1)


def test_a_mirrored_picture_gives_a_mirrored_texture(face, img):
    """The atlas is symmetric, so the mirrored face bakes to the mirrored atlas."""
    model, camera = face.model, face.camera
    flip = np.diag([-1.0, 1, 1])
    mirrored_camera = ScaledOrthographicCamera(
        camera.scale,
        flip @ camera.rotation @ flip,
        [img.shape[1] - 1 - camera.translation[0], camera.translation[1]],
    )
    mirrored = dataclasses.replace(
        face,
        vertices=(face.vertices * [-1, 1, 1])[model.mirror],
        camera=mirrored_camera,
        landmark_vertices=model.mirror[face.landmark_vertices][MIRROR],
    )
    both = (
        bake_texture(img, face, size=512),
        bake_texture(np.ascontiguousarray(img[:, ::-1]), mirrored, size=512),
    )
    fragments = _atlas_fragments(model, 512)
    front = fragments.mask & face.region("face")[face.faces].all(1)[fragments.face_ids]
    difference = np.abs(both[0].astype(int) - both[1][:, ::-1])[front & front[:, ::-1]]
    assert difference.mean() < 3


def test_a_dark_outline_of_the_cheeks_is_not_drawn_out_over_the_sides(face):
    """Skin that is seen at a slant takes the colour of what is seen well; the picture is dark where it turns away."""
    model, camera = face.model, face.camera
    shape = 800, 800
    fragments = rasterize(
        np.column_stack([camera.project(face.vertices), camera.depth(face.vertices)]), face.faces, *shape
    )
    picture = face_picture(np.full((*shape, 3), 200, np.uint8), face)
    cosines = interpolate(fragments, face.faces, picture.cosines)
    img = np.where((fragments.mask & (cosines > 0.5))[..., None], np.uint8([220, 170, 140]), np.uint8([110, 60, 40]))
    corner = np.zeros(len(face.vertices), int)
    corner[model.faces.ravel()] = model.uv_faces.ravel()
    texels = sample_image(bake_texture(img, face, size=512), uv_to_px(model.uv[corner], 512, 512))
    cheeks = model.region("cheek_left") | model.region("cheek_right")
    slant = cheeks & (picture.cosines > 0.1) & (picture.cosines < 0.35)
    assert slant.sum() > 50
    assert np.median(texels[slant, 0]) > 190


def test_the_skin_of_the_texture_is_that_of_the_picture(face, img):
    """Where a front vertex is seen, the atlas has the colour of the picture at its pixel."""
    model = face.model
    atlas = bake_texture(img, face)
    picture = face_picture(img, face)
    cheeks = (model.region("cheek_left") | model.region("cheek_right")) & (picture.cosines > 0.7)
    corner = np.zeros(len(face.vertices), int)
    corner[model.faces.ravel()] = model.uv_faces.ravel()
    texels = sample_image(atlas, uv_to_px(model.uv[corner], 1024, 1024))[cheeks]
    pixels = sample_image(img, face.project(face.vertices))[cheeks]
    assert np.median(np.abs(texels - pixels)) < 3


def test_background_never_reaches_the_back_of_the_head(face, img):
    loud = img.copy()
    hull = np.zeros(img.shape[:2], bool)
    px = face.project(face.vertices[face.landmark_vertices])
    low, high = np.floor(px.min(0)).astype(int), np.ceil(px.max(0)).astype(int)
    hull[low[1] : high[1], low[0] : high[0]] = True
    loud[~hull] = (255, 0, 255)
    atlas = bake_texture(loud, face, size=512)
    behind = face.region("scalp") | face.region("neck")
    fragments = _atlas_fragments(face.model, 512)
    texels = atlas[fragments.mask & behind[face.faces].all(1)[fragments.face_ids]].astype(int)
    magenta = np.minimum(texels[:, 0], texels[:, 2]) - texels[:, 1]
    clean = bake_texture(img, face, size=512)[fragments.mask & behind[face.faces].all(1)[fragments.face_ids]].astype(
        int
    )
    assert (magenta - (np.minimum(clean[:, 0], clean[:, 2]) - clean[:, 1])).max() < 12


def test_a_large_picture_is_reduced_and_pixels_are_placed(face, img):
    factor = 8
    large = cv2.resize(img, None, fx=factor, fy=factor, interpolation=cv2.INTER_NEAREST)
    camera = face.camera.scaled(factor)
    picture = face_picture(large, dataclasses.replace(face, camera=camera))
    assert max(picture.pixels.shape[:2]) == MAX_SIDE
    np.testing.assert_allclose(picture.place(camera.project(face.vertices)), picture.points, atol=1e-9)


def test_skin_excludes_eyes_mouth_and_background(face, img):
    picture = face_picture(img, face)
    landmarks = picture.place(face.project(face.vertices[face.landmark_vertices]))
    eye = opening_mask(landmarks, EYE_LEFT, picture.skin.shape)
    assert eye.sum() > 50 and not (picture.skin & eye).any()
    assert not (picture.sure & ~picture.skin).any()
    white = (picture.pixels.astype(int).min(2) > 250) & ~picture.openings
    assert (picture.sure & white).sum() == 0


def test_opening_mask_of_a_square_diamond():
    """Eye corners left and right, lids straight: the mask is the polygon."""
    landmarks = np.full((68, 2), np.nan)
    landmarks[[36, 37, 38, 39, 40, 41]] = [[2, 10], [8, 4], [14, 4], [20, 10], [14, 16], [8, 16]]
    mask = opening_mask(landmarks, OPENINGS[0], (21, 23))
    np.testing.assert_array_equal(mask, mask[::-1])
    assert (mask != mask[:, ::-1]).sum() <= 4  # ties of the polygon filler
    assert mask[10, 11] and not mask[2, 2] and 120 < mask.sum() < 220


def test_skin_that_an_expression_stretches_takes_no_drawing(face, img):
    """An expression that does nothing changes no texel; one that blows up the cheek takes the drawing off it."""
    model = face.model
    nothing = np.zeros((9, *face.vertices.shape), np.float32)
    still = Rig(("still",), face.vertices, nothing[:1], nothing[1:], np.zeros(1), {"seconds": 0.0})
    plain = bake_texture(img, face, size=256)
    np.testing.assert_array_equal(bake_texture(img, face, rig=still, size=256), plain)
    lips = model.region("lips")
    delta = np.where(lips[:, None], 3 * (face.vertices - face.vertices[lips].mean(0)), 0).astype(np.float32)
    blown = bake_texture(img, face, rig=dataclasses.replace(still, deltas=delta[None]), size=256)
    fragments = _atlas_fragments(model, 256)
    on_lips = fragments.mask & lips[face.faces].all(1)[fragments.face_ids]
    assert np.abs(blown[on_lips].astype(int) - plain[on_lips]).mean() > 5
    away = fragments.mask & ~model.region("mouth")[face.faces].any(1)[fragments.face_ids]
    np.testing.assert_array_equal(blown[away], plain[away])


def test_a_grey_picture_gives_a_grey_head(face, img):
    grey = np.repeat(cv2.cvtColor(img, cv2.COLOR_RGB2GRAY)[..., None], 3, axis=2)
    atlas = bake_texture(grey, face, size=256).astype(int)
    assert np.ptp(atlas, axis=2).max() <= 1


def test_bad_arguments_are_named(face, img):
    with pytest.raises(ValueError, match=r"img: expected \(H, W, 3\) uint8 RGB, got float64"):
        bake_texture(img / 255.0, face)
    for size in (31, 8193, 64.0, "64"):
        with pytest.raises(ValueError, match=rf"size: expected an integer from 32 to 8192 texels, got {size!r}"):
            bake_texture(img, face, size=size)
