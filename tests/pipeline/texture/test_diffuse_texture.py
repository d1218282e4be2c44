"""Breadth-first diffusion: exact cases, symmetry, and the sequential order as an oracle where both agree."""

import numpy as np
import pytest

from toongeo.pipeline.texture.diffuse_texture import diffuse_texture

OPTIONS = [(order, connectivity) for order in ("layers", "sequential") for connectivity in (4, 8)]


@pytest.fixture(params=OPTIONS, ids=lambda option: f"{option[0]}-{option[1]}")
def options(request):
    return {"order": request.param[0], "connectivity": request.param[1]}


@pytest.fixture
def mask():
    y, x = np.mgrid[:40, :56]
    holes = (x - 30) ** 2 + (y - 15) ** 2 < 20
    return (((x - 25) / 18) ** 2 + ((y - 17) / 12) ** 2 < 1) & ~holes


def picture(mask, dtype, channels=3):
    rng = np.random.default_rng(0)
    shape = (*mask.shape, channels) if channels else mask.shape
    if np.dtype(dtype).kind == "u":
        return rng.integers(0, np.iinfo(dtype).max, shape, dtype=dtype, endpoint=True)
    return rng.random(shape).astype(dtype)


def slow_layers(img, mask, connectivity):
    """Layer after layer, pixel by pixel."""
    steps = [(-1, 0), (0, -1), (0, 1), (1, 0)]
    steps += [(-1, -1), (-1, 1), (1, -1), (1, 1)] if connectivity == 8 else []
    out, known = img.astype(float), mask.copy()
    while not known.all():
        before = known.copy()
        for y, x in np.argwhere(~before):
            near = [(y + a, x + b) for a, b in steps if 0 <= y + a < len(mask) and 0 <= x + b < mask.shape[1]]
            near = [p for p in near if before[p]]
            if near:
                out[y, x] = np.mean([out[p] for p in near], axis=0)
                known[y, x] = True
    return out


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("channels", [0, 1, 3, 4])
def test_layers_are_the_slow_layers(mask, channels, connectivity):
    img = picture(mask, np.float64, channels)
    expected = slow_layers(img, mask, connectivity)
    np.testing.assert_allclose(diffuse_texture(img, mask, connectivity=connectivity), expected, atol=1e-13)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_a_constant_colour_is_exact(mask, options, dtype):
    colour = np.array([250, 3, 77]) if np.dtype(dtype).kind == "u" else np.array([0.1, 0.7, 1 / 3])
    colour = colour.astype(dtype)
    img = np.where(mask[:, :, None], colour, 99).astype(dtype)
    result = diffuse_texture(img, mask, **options)
    assert result.dtype == dtype
    np.testing.assert_array_equal(result, np.broadcast_to(colour, img.shape))


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32, np.float64])
@pytest.mark.parametrize("channels", [0, 3])
def test_known_pixels_dtype_and_range_are_kept(mask, options, dtype, channels):
    img = picture(mask, dtype, channels)
    result = diffuse_texture(img, mask, **options)
    assert result.dtype == dtype and result.shape == img.shape
    np.testing.assert_array_equal(result[mask], img[mask])
    low, high = img[mask].min(axis=0), img[mask].max(axis=0)  # the maximum principle, up to rounding
    slack = 0 if np.dtype(dtype).kind == "u" else 4 * np.finfo(dtype).eps
    assert (result >= low - slack).all() and (result <= high + slack).all()


@pytest.mark.parametrize("connectivity", [4, 8])
def test_mirrored_and_transposed_pictures_give_the_same_to_the_bit(mask, connectivity):
    img = picture(mask, np.float32)
    expected = diffuse_texture(img, mask, connectivity=connectivity)
    turns = [
        lambda a: a[::-1],
        lambda a: a[:, ::-1],
        lambda a: np.swapaxes(a, 0, 1),
        lambda a: np.swapaxes(a, 0, 1)[::-1],
    ]
    for turn in turns:
        result = diffuse_texture(turn(img), turn(mask), connectivity=connectivity)
        np.testing.assert_array_equal(result, turn(expected))


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("turn", [np.asarray, np.transpose])
def test_both_orders_agree_on_strips_with_odd_gaps(connectivity, turn):
    # In an even gap the two middle pixels are neighbours of one layer: the later one sees the earlier.
    img = np.random.default_rng(1).random((1, 60))
    known = np.zeros((1, 60), dtype=bool)
    known[0, [3, 4, 6, 10, 16, 24, 34, 54]] = True
    options = {"img": turn(img), "mask": turn(known), "connectivity": connectivity}
    expected = diffuse_texture(**options, order="sequential")
    np.testing.assert_allclose(diffuse_texture(**options), expected, atol=1e-15)


def test_the_middle_of_an_odd_gap_is_the_mean():
    img, known = np.array([[0.0, 9, 9, 9, 1]]), np.array([[1, 0, 0, 0, 1]], dtype=bool)
    for order in ("layers", "sequential"):
        np.testing.assert_array_equal(diffuse_texture(img, known, order=order), [[0, 0, 0.5, 1, 1]])


def test_both_orders_agree_where_each_layer_is_uniform():
    # A straight edge: each layer is a row of one colour, whatever the order within it.
    img = np.zeros((9, 12))
    img[:2] = np.array([[0.25], [0.75]])
    known = np.zeros_like(img, dtype=bool)
    known[:2] = True
    for order in ("layers", "sequential"):
        np.testing.assert_array_equal(diffuse_texture(img, known, order=order)[1:], 0.75)


def test_one_known_pixel_fills_the_picture(options):
    img = np.arange(35, dtype=np.uint8).reshape(5, 7)
    known = img == 17
    np.testing.assert_array_equal(diffuse_texture(img, known, **options), np.full_like(img, 17))


def test_unknown_values_are_not_used_and_arguments_not_written_to(mask, options):
    img = picture(mask, np.float64)
    expected = diffuse_texture(img, mask, **options)
    poisoned = np.where(mask[:, :, None], img, np.nan)
    copies = poisoned.copy(), mask.copy()
    np.testing.assert_array_equal(diffuse_texture(poisoned, mask, **options), expected)
    np.testing.assert_array_equal(poisoned, copies[0])
    np.testing.assert_array_equal(mask, copies[1])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mask": np.zeros((4, 5), bool)}, r"mask: expected at least one known pixel \(True\), got none"),
        ({"mask": np.ones((4, 5), bool)}, r"mask: expected at least one unknown pixel \(False\), got none"),
        ({"mask": np.ones((5, 4), bool)}, r"mask: expected bool of shape \(4, 5\), got bool \(5, 4\)"),
        ({"mask": np.ones((4, 5))}, "mask: expected bool .* got float64"),
        ({"img": np.zeros(5)}, r"img: expected uint8.* got float64 \(5,\)"),
        ({"img": np.zeros((0, 5, 3))}, r"img: expected uint8.* got float64 \(0, 5, 3\)"),
        ({"img": np.zeros((4, 5), int)}, "img: expected uint8.* got int64"),
        ({"img": np.full((4, 5), np.nan)}, "img: expected finite values where mask is True"),
        ({"order": "random"}, "order: expected 'layers' or 'sequential', got 'random'"),
        ({"connectivity": 6}, "connectivity: expected 4 or 8, got 6"),
    ],
)
def test_bad_input_is_named(change, message):
    arguments = {"img": np.zeros((4, 5)), "mask": np.eye(4, 5, dtype=bool)} | change
    with pytest.raises(ValueError, match=message):
        diffuse_texture(**arguments)


@pytest.mark.parametrize("most", [1.7e308, 1e300, -1.7e308])
def test_the_largest_floats_stay_finite(options, most):
    known = np.eye(6, dtype=bool)
    found = diffuse_texture(np.full((6, 6), most), known, **options)
    np.testing.assert_allclose(found, most, rtol=1e-12)
    small = np.finfo(np.float32).max
    assert (diffuse_texture(np.full((4, 4), small), np.eye(4, dtype=bool), **options) == small).all()
