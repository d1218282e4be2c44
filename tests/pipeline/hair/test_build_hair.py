import cv2
import numpy as np
import pytest

from toongeo.geometry import self_intersections
from toongeo.model.anatomy.neck import neck_rim
from toongeo.pipeline import Hair, build_hair, make_room
from toongeo.render import Surface, interpolate, rasterize, render_mesh


def edge_counts(F):
    edges = np.sort(np.vstack([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), 1)
    return np.unique(edges, axis=0, return_counts=True)[1]


def depths(camera, V, F, shape):
    fragments = rasterize(np.column_stack([camera.project(V), camera.depth(V)]), F, *shape)
    return np.where(fragments.mask, interpolate(fragments, F, camera.depth(V)), -np.inf)


def test_shell_is_closed_and_does_not_cross_itself(hair):
    assert (edge_counts(hair.faces) == 2).all()
    assert len(self_intersections(hair.vertices, hair.faces)) == 0
    assert len(hair.faces) <= 15_000
    assert len(np.unique(hair.faces)) == len(hair.vertices)


def test_faces_look_outwards(hair):
    a, b, c = (hair.vertices[hair.faces[:, k]] for k in range(3))
    assert (np.cross(a, b) * c).sum() / 6 > 5e5  # mm3: a head of hair


def test_hair_that_is_seen_is_the_mask(hair, roomy, mask):
    face, _ = roomy
    shape = mask.shape
    skin = depths(face.camera, face.vertices, face.faces, shape)
    seen = depths(face.camera, hair.vertices, hair.faces, shape) > skin
    assert (seen & mask).sum() / (seen | mask).sum() > 0.96


def test_no_expression_comes_through(hair, roomy, mask):
    face, rig = roomy
    front = depths(face.camera, hair.vertices, hair.faces, mask.shape)
    outer = face.faces[face.region("skin")[face.faces].all(1)]
    inner = mask & np.isfinite(front)
    for name in ("browInnerUpLeft", "browOuterUpRight", "jawOpen", "cheekPuffLeft"):
        skin = depths(face.camera, rig.vertices({name: 1.0}), outer, mask.shape)
        assert (skin > front + 1.0)[inner].mean() < 1e-3


def test_no_hair_is_seen_in_the_end_of_the_neck(avatars, cartoon):
    """Hair that hangs on both sides of the neck, down to where it ends, closes behind it, not below it."""
    bare = avatars("blue_girl")
    mask = bare.parse.hair.mask
    face, rig = make_room(bare.face, bare.rig, mask, bare.parse)
    rim = face.vertices[neck_rim(face.model)]
    middle, axes = rim.mean(axis=0), np.linalg.svd(rim - rim.mean(axis=0))[2]
    down = -axes[2] * np.sign(axes[2, 1])
    outline = (0.95 * (rim - middle) @ axes[:2].T).astype(np.float32)
    away = build_hair(cartoon("blue_girl")[0], face, rig, mask).vertices - middle
    under = away[away @ down > 1.0]
    within = [cv2.pointPolygonTest(outline, (x, y), False) > 0 for x, y in under @ axes[:2].T]
    assert len(within) > 50  # beside the neck it hangs lower
    assert not any(within)


def test_texture_holds_the_picture_in_front(hair, picture, roomy, mask):
    """Where hair faces the camera deep inside the mask, its colour is that of the picture."""
    face, _ = roomy
    img = picture[0]
    surface = Surface(hair.vertices, hair.faces, uv=hair.uv, uv_faces=hair.uv_faces, texture=hair.texture)
    image = render_mesh(surface, face.camera, img.shape[:2], shading="unlit")
    brown = cv2.erode((mask & (np.abs(img.astype(int) - [117, 51, 0]).max(2) < 8)).astype(np.uint8), np.ones((9, 9)))
    brown[:, :110] = brown[:, -110:] = 0  # at the sides strands take over
    assert brown.sum() > 500
    off = np.abs(image.astype(int) - img)[brown > 0].max(1)
    assert np.quantile(off, 0.8) < 14  # levels; it is 13


def test_same_picture_same_hair(hair, picture, roomy, mask):
    again = build_hair(picture[0], *roomy, mask)
    for name in ("vertices", "faces", "uv", "uv_faces", "texture"):
        np.testing.assert_array_equal(getattr(again, name), getattr(hair, name))


def test_vertices_are_numbers_of_float32(hair):
    np.testing.assert_array_equal(hair.vertices, hair.vertices.astype(np.float32))


def test_masks_that_cannot_be(picture, roomy, mask):
    with pytest.raises(ValueError, match=r"mask: expected \(400, 336\) bool, got \(4, 4\)"):
        build_hair(picture[0], *roomy, np.ones((4, 4), bool))
    corner = np.zeros_like(mask)
    corner[-20:, :20] = True
    with pytest.raises(ValueError, match="mask: expected hair on the head, got none near it"):
        build_hair(picture[0], *roomy, corner)


TRIANGLE = {
    "vertices": np.eye(3),
    "faces": np.array([[0, 1, 2]]),
    "uv": np.eye(3)[:, :2],
    "uv_faces": np.array([[0, 1, 2]]),
    "texture": np.zeros((2, 2, 3), np.uint8),
}


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("vertices", np.eye(2), r"vertices: expected finite numbers \(n, 3\)"),
        ("uv", np.full((3, 2), np.nan), r"uv: expected finite numbers \(n, 2\)"),
        ("faces", np.array([[0, 1, 3]]), "faces: expected indices"),
        ("uv_faces", np.array([[0, 1, 2]] * 2), r"uv_faces: expected indices \(1, 3\)"),
        ("texture", np.zeros((2, 2, 3)), r"texture: expected \(H, W, 3\) uint8"),
    ],
)
def test_hair_is_checked(name, value, message):
    with pytest.raises(ValueError, match=message):
        Hair(**{**TRIANGLE, name: value})


def test_hair_cannot_be_written_to():
    hair = Hair(**TRIANGLE)
    with pytest.raises(ValueError, match="read-only"):
        hair.vertices[0] = 0
