import numpy as np
import pytest

from toongeo.render import (
    ScaledOrthographicCamera,
    Surface,
    irradiance,
    linear_to_srgb,
    render_mesh,
    srgb_to_linear,
    studio_light,
)

CAMERA = ScaledOrthographicCamera(1.0, np.eye(3), [15.5, 15.5])  # the 32 px picture spans +-16 mm
SQUARE = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
SQUARE_UV = (SQUARE[:, :2] + 1.0) / 2.0
SQUARE_FACES = np.array([[0, 1, 2], [0, 2, 3]])


def square(side=40.0, z=0.0, colour=None, **keywords):
    colours = None if colour is None else np.tile(np.asarray(colour, float), (4, 1))
    return Surface(SQUARE * side / 2 + [0, 0, z], SQUARE_FACES, colours=colours, **keywords)


def textured(texture, side=32.0):
    return square(side, uv=SQUARE_UV, uv_faces=SQUARE_FACES, texture=texture)


def sphere(radius=12.0, count=40, **keywords):
    u, v = np.mgrid[: count + 1, : 2 * count] * np.pi / count
    points = np.stack([np.sin(u) * np.sin(v), np.cos(u), np.sin(u) * np.cos(v)], -1).reshape(-1, 3)
    index = np.arange(len(points)).reshape(count + 1, -1)
    a, b, c, d = index[:-1], index[1:], np.roll(index, -1, 1)[1:], np.roll(index, -1, 1)[:-1]
    F = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return Surface(radius * points, F, **keywords)


@pytest.mark.parametrize("supersample", [1, 2, 3])
def test_unlit_colour_comes_out_as_it_went_in(supersample):
    picture = render_mesh(square(colour=[0.2, 0.6, 1.0]), CAMERA, 32, shading="unlit", supersample=supersample)
    assert picture.dtype == np.uint8 and picture.shape == (32, 32, 3)
    assert (picture == [51, 153, 255]).all()


def test_unlit_texture_at_its_own_size_comes_out_as_it_went_in():
    texture = np.random.default_rng(0).integers(0, 256, (32, 32, 3), dtype=np.uint8)
    picture = render_mesh(textured(texture), CAMERA, 32, shading="unlit", supersample=1)
    assert np.abs(picture.astype(int) - texture).max() <= 1


def test_texture_is_upright_and_not_mirrored():
    texture = np.zeros((8, 8, 3), np.uint8)
    texture[:4, :4, 0] = texture[:4, 4:, 1] = texture[4:, :4, 2] = 255
    picture = render_mesh(textured(texture), CAMERA, 32, shading="unlit")
    assert picture[8, 8].tolist() == [255, 0, 0] and picture[8, 24].tolist() == [0, 255, 0]
    assert picture[24, 8].tolist() == [0, 0, 255] and picture[24, 24].tolist() == [0, 0, 0]


def test_a_minified_texture_is_averaged_in_linear_light():
    texture = np.zeros((256, 256, 3), np.uint8)
    texture[::2] = 255  # stripes far finer than a pixel
    picture = render_mesh(textured(texture), CAMERA, 32, shading="unlit", supersample=2)
    inner = picture[4:-4, 4:-4].astype(int)
    assert np.abs(inner - round(255 * float(linear_to_srgb(0.5)))).max() <= 1


def test_lambert_at_every_pixel_of_a_sphere():
    light = studio_light() * [1.0, 0.8, 0.6]
    albedo = np.array([0.7, 0.6, 0.5])
    ball = sphere(count=90)
    painted = Surface(ball.vertices, ball.faces, colours=np.tile(albedo, (len(ball.vertices), 1)))
    picture = render_mesh(painted, CAMERA, 32, light=light, supersample=1)
    y, x = np.mgrid[:32, :32]
    nx, ny = (x - 15.5) / 12.0, (15.5 - y) / 12.0
    inside = nx**2 + ny**2 < 0.8
    normals = np.stack([nx, ny, np.sqrt(np.maximum(1 - nx**2 - ny**2, 0))], -1)[inside]
    linear = irradiance(normals, light) / np.pi * srgb_to_linear(albedo)
    assert np.abs(picture[inside] - 255.0 * linear_to_srgb(np.clip(linear, 0, 1))).max() < 1.5


def test_light_stays_with_the_camera():
    turned = ScaledOrthographicCamera(1.0, ScaledOrthographicCamera.look(50.0, 20.0).rotation, CAMERA.translation)
    difference = render_mesh(sphere(), CAMERA, 32).astype(int) - render_mesh(sphere(), turned, 32)
    assert np.abs(difference).max() <= 6  # but for the facets of the outline
    assert np.abs(difference).mean() < 0.1


def test_given_normals_are_used():
    flat = square(colour=[0.5] * 3)
    tilted = square(colour=[0.5] * 3, normals=np.tile([0.0, 1.0, 0.0], (4, 1)))
    up, facing = irradiance([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], studio_light())[:, 0] / np.pi
    for surface, shade in ((flat, facing), (tilted, up)):
        expected = 255 * linear_to_srgb(shade * srgb_to_linear(0.5))
        assert render_mesh(surface, CAMERA, 32)[16, 16, 0] == pytest.approx(expected, abs=1)


def test_nearer_surfaces_hide_farther_ones_in_any_order():
    near, far = square(16.0, 5.0, [1, 0, 0]), square(24.0, -5.0, [0, 1, 0])
    first = render_mesh([near, far], CAMERA, 32, shading="unlit")
    assert (first == render_mesh([far, near], CAMERA, 32, shading="unlit")).all()
    assert first[16, 16].tolist() == [255, 0, 0] and first[16, 5].tolist() == [0, 255, 0]


def test_surfaces_with_different_paint_share_a_picture():
    red, blue = np.zeros((2, 4, 4, 3), np.uint8)
    red[..., 0] = blue[..., 2] = 255
    parts = [
        Surface(SQUARE * 4 + [-8, 0, 0], SQUARE_FACES, uv=SQUARE_UV, uv_faces=SQUARE_FACES, texture=red),
        Surface(SQUARE * 4 + [8, 0, 0], SQUARE_FACES, uv=SQUARE_UV, uv_faces=SQUARE_FACES, texture=blue),
        Surface(SQUARE * 3, SQUARE_FACES, colours=np.tile([0.0, 1.0, 0.0], (4, 1))),
        Surface(SQUARE * 3 + [0, 10, 0], SQUARE_FACES),
    ]
    picture = render_mesh(parts, CAMERA, 32, shading="unlit", background=(0, 0, 0))
    assert [picture[16, x].tolist() for x in (8, 16, 24)] == [[255, 0, 0], [0, 255, 0], [0, 0, 255]]
    assert np.abs(picture[6, 16] - 0.7 * 255).max() <= 1  # the grey of the unpainted
    assert picture[30, 16].tolist() == [0, 0, 0]


def test_edges_are_averaged_by_area_in_linear_light():
    # the square ends a quarter into the pixel column 24
    half = Surface(SQUARE * [8.75, 20, 0], SQUARE_FACES, colours=np.ones((4, 3)))
    picture = render_mesh(half, CAMERA, 32, shading="unlit", background=(0, 0, 0), supersample=4)
    expected = round(255 * float(linear_to_srgb(0.75)))
    assert np.abs(picture[16, [7, 24], 0].astype(int) - expected).max() <= 1
    assert picture[16, 8, 0] == 255 and picture[16, 6, 0] == 0


@pytest.mark.parametrize("supersample", [1, 2])
def test_background_picture_is_kept_where_nothing_is_drawn(supersample):
    back = np.random.default_rng(1).integers(0, 256, (24, 32, 3), dtype=np.uint8)
    assert (render_mesh([], CAMERA, (24, 32), background=back, supersample=supersample) == back).all()
    over = render_mesh(square(6.0), CAMERA, (24, 32), background=back, supersample=supersample)
    assert (over[:, :10] == back[:, :10]).all() and (over != back).any()


def test_clay_shows_shape_not_colour():
    ball = sphere()
    painted = Surface(ball.vertices, ball.faces, colours=np.random.default_rng(2).random((len(ball.vertices), 3)))
    clay = render_mesh(ball, CAMERA, 32, shading="clay")
    assert (clay == render_mesh(painted, CAMERA, 32, shading="clay")).all()
    grey = clay.astype(int).sum(axis=2)
    assert grey[10, 10] > grey[22, 22] + 60  # lit from the upper left
    assert clay.min() > 0 and clay[8:24, 8:24].max() < 255  # nothing is crushed or burnt out


def test_clay_darkens_hollows_and_brightens_ridges():
    n = 41
    x, y = np.meshgrid(np.linspace(-20, 20, n), np.linspace(-20, 20, n))
    index = np.arange(n * n).reshape(n, n)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    F = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    centre = {}
    for name, height in (("hollow", -1.5), ("flat", 0.0), ("ridge", 1.5)):
        z = height * np.exp(-(x**2 + y**2) / 8.0)
        bump = Surface(np.stack([x, y, z], -1).reshape(-1, 3), F)
        centre[name] = render_mesh(bump, CAMERA, 33, shading="clay")[15:17, 15:17].mean()
    assert centre["hollow"] < centre["flat"] - 8 and centre["ridge"] > centre["flat"] + 2


def test_scale_of_the_scene_does_not_matter():
    for factor in (1e-4, 1e4):
        ball = sphere(count=20)
        scaled = Surface(ball.vertices * factor, ball.faces)
        camera = ScaledOrthographicCamera(1.0 / factor, np.eye(3), CAMERA.translation)
        for shading in ("lit", "clay"):
            difference = render_mesh(scaled, camera, 32, shading=shading).astype(int) - render_mesh(
                ball, CAMERA, 32, shading=shading
            )
            assert (np.abs(difference).max(axis=2) > 1).mean() < 0.01


def test_size_may_be_a_height_and_a_width():
    texture = np.random.default_rng(2).integers(0, 256, (32, 32, 3), dtype=np.uint8)
    whole = render_mesh(textured(texture), CAMERA, 32)
    np.testing.assert_array_equal(render_mesh(textured(texture), CAMERA, (10, 20)), whole[:10, :20])


def test_a_scene_outside_the_picture_leaves_the_background():
    picture = render_mesh(square(4.0, colour=[0, 0, 0]), CAMERA.scaled(1.0), (3, 3), background=(1, 1, 1))
    assert (picture == 255).all()


def test_an_edge_on_textured_surface_renders():
    side_on = ScaledOrthographicCamera(1.0, ScaledOrthographicCamera.look(90.0).rotation, [15.5, 15.5])
    picture = render_mesh(textured(np.zeros((4, 4, 3), np.uint8)), side_on, 32, background=(1, 1, 1))
    assert (np.delete(picture, [15, 16], axis=1) == 255).all()  # at most a line is seen of it


def test_second_run_is_bit_identical():
    parts = [sphere(), textured(np.random.default_rng(3).integers(0, 256, (64, 64, 3), dtype=np.uint8))]
    for shading in ("lit", "unlit", "clay"):
        first = render_mesh(parts, CAMERA, 64, shading=shading)
        assert first.tobytes() == render_mesh(parts, CAMERA, 64, shading=shading).tobytes()


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"size": 0}, "size: expected positive"),
        ({"size": (4, 0)}, "size: expected positive"),
        ({"supersample": 0}, "supersample: expected an integer"),
        ({"supersample": 1.5}, "supersample: expected an integer"),
        ({"shading": "shiny"}, "shading: expected one of"),
        ({"background": (0.0, 0.0)}, "background: expected 3 numbers"),
        ({"background": (0.0, 0.0, np.nan)}, "background: expected 3 numbers"),
        ({"background": np.zeros((4, 4, 3), np.uint8)}, r"uint8 picture of shape \(512, 512, 3\)"),
        ({"light": np.zeros(9)}, "light: expected finite"),
    ],
)
def test_bad_arguments(keywords, message):
    with pytest.raises(ValueError, match=message):
        render_mesh(square(), CAMERA, **keywords)


TEXTURE = np.zeros((4, 4, 3), np.uint8)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"vertices": SQUARE[:, :2]}, "vertices: expected real numbers"),
        ({"vertices": SQUARE * np.nan}, "vertices: expected finite"),
        ({"faces": SQUARE_FACES + 2}, r"faces: expected indices in 0\.\.3"),
        ({"faces": SQUARE_FACES * 1.0}, "faces: expected integers"),
        ({"colours": np.zeros((3, 3))}, r"colours: expected shape \(4, 3\), got \(3, 3\)"),
        ({"colours": np.full((4, 3), np.nan)}, "colours: expected finite"),
        ({"normals": np.zeros((4, 2))}, "normals: expected real numbers"),
        ({"texture": TEXTURE}, "texture: expected it with uv and uv_faces, got only texture"),
        ({"uv": SQUARE_UV, "uv_faces": SQUARE_FACES}, "got only uv, uv_faces"),
        ({"texture": TEXTURE, "uv": SQUARE, "uv_faces": SQUARE_FACES}, "uv: expected finite coordinates"),
        ({"texture": TEXTURE, "uv": SQUARE_UV + np.inf, "uv_faces": SQUARE_FACES}, "uv: expected finite"),
        ({"texture": TEXTURE, "uv": SQUARE_UV, "uv_faces": SQUARE_FACES[:1]}, "uv_faces: expected 2 rows"),
        ({"texture": TEXTURE, "uv": SQUARE_UV, "uv_faces": SQUARE_FACES + 9}, "uv_faces: expected indices"),
        ({"texture": TEXTURE / 2, "uv": SQUARE_UV, "uv_faces": SQUARE_FACES}, "texture: expected uint8"),
        ({"texture": TEXTURE[..., 0], "uv": SQUARE_UV, "uv_faces": SQUARE_FACES}, "texture: expected uint8"),
    ],
)
def test_bad_surfaces(keywords, message):
    with pytest.raises(ValueError, match=message):
        Surface(**{"vertices": SQUARE, "faces": SQUARE_FACES, **keywords})


def test_surface_does_not_lock_the_arrays_it_was_given():
    vertices = SQUARE.copy()
    surface = Surface(vertices, SQUARE_FACES)
    vertices[0, 0] = 7.0
    with pytest.raises(ValueError, match="read-only"):
        surface.vertices[0, 0] = 3.0
