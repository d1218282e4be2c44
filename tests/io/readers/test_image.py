"""Pictures of every kind, against pixels made by numpy."""

import io
import struct
import zlib

import cv2
import numpy as np
import pytest
from PIL import Image

from toongeo.io import encode_image, read_image, write_image

# What a viewer does to the stored pixels, by EXIF orientation (TIFF 6.0 / EXIF 2.3, tag 274).
UPRIGHT = {
    1: lambda a: a,
    2: lambda a: a[:, ::-1],
    3: lambda a: a[::-1, ::-1],
    4: lambda a: a[::-1],
    5: lambda a: a.swapaxes(0, 1),
    6: lambda a: a.swapaxes(0, 1)[:, ::-1],
    7: lambda a: a[::-1, ::-1].swapaxes(0, 1),
    8: lambda a: a.swapaxes(0, 1)[::-1],
}


@pytest.fixture
def rgb():
    return np.random.default_rng(1).integers(0, 256, (11, 7, 3), dtype=np.uint8)


def on_white(rgba, top):
    rgba = rgba.astype(float) / top
    return 255 * (rgba[..., :-1] * rgba[..., -1:] + 1 - rgba[..., -1:])


@pytest.mark.parametrize("name", ["a.png", "Ünïcode 顔.PNG", "a.bmp", "a.tiff", "a.webp"])
def test_lossless_formats(tmp_path, rgb, name):
    path = tmp_path / name
    Image.fromarray(rgb).save(path, **({"lossless": True} if name.endswith("webp") else {}))
    for given in (path, str(path)):
        np.testing.assert_array_equal(read_image(given), rgb)
    assert read_image(path).dtype == np.uint8 and read_image(path).flags.writeable


@pytest.mark.parametrize("suffix", [".jpg", ".JPEG", ".webp"])
def test_lossy_formats(tmp_path, suffix):
    smooth = np.stack(np.meshgrid(np.arange(64) * 3, np.arange(48) * 4), axis=-1)
    smooth = np.dstack([smooth, np.full((48, 64), 90)]).astype(np.uint8)
    write_image(tmp_path / f"a{suffix}", smooth, quality=95)
    assert np.abs(read_image(tmp_path / f"a{suffix}").astype(int) - smooth).mean() < 3


@pytest.mark.parametrize("orientation", UPRIGHT)
@pytest.mark.parametrize("kind", ["png", "webp", "tiff", "jpeg"])
def test_exif_rotation(tmp_path, rgb, orientation, kind):
    exif = Image.Exif()
    exif[274] = orientation
    if kind == "jpeg":  # blocks of one colour survive compression
        rgb = np.repeat(np.repeat(rgb, 16, axis=0), 16, axis=1)
    options = {"webp": {"lossless": True}, "jpeg": {"quality": 95, "subsampling": 0}}.get(kind, {})
    Image.fromarray(rgb).save(tmp_path / f"a.{kind}", exif=exif, **options)
    got, expected = read_image(tmp_path / f"a.{kind}"), UPRIGHT[orientation](rgb)
    assert got.shape == expected.shape
    np.testing.assert_allclose(got.astype(int), expected, atol=20 if kind == "jpeg" else 0)


def test_exif_rotation_with_alpha(tmp_path, rgb):
    rgba = np.dstack([rgb, np.random.default_rng(2).integers(0, 256, (11, 7), dtype=np.uint8)])
    exif = Image.Exif()
    exif[274] = 6
    Image.fromarray(rgba).save(tmp_path / "a.png", exif=exif)
    expected = UPRIGHT[6](on_white(rgba, 255))
    np.testing.assert_allclose(read_image(tmp_path / "a.png"), expected, atol=0.51)


@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize("kind", ["png", "tiff"])
def test_sixteen_bits(tmp_path, channels, kind):
    pixels = np.random.default_rng(3).integers(0, 65536, (9, 5, channels), dtype=np.uint16)
    pixels[0, 0] = 65535
    pixels[0, 1] = 0
    # OpenCV writes BGR(A).
    stored = pixels[..., [2, 1, 0, 3][:channels]] if channels > 1 else pixels
    assert cv2.imwrite(str(tmp_path / f"a.{kind}"), stored)
    expected = on_white(pixels, 65535) if channels == 4 else pixels / 257
    np.testing.assert_allclose(read_image(tmp_path / f"a.{kind}"), np.broadcast_to(expected, (9, 5, 3)), atol=1.5)


def test_sixteen_bits_that_repeat_eight_are_exact(tmp_path, rgb):
    for stored in (rgb.astype(np.uint16) * 257, rgb[..., :1].astype(np.uint16) * 257):
        cv2.imwrite(str(tmp_path / "a.png"), stored[..., ::-1])
        expected = (stored // 257).astype(np.uint8)
        np.testing.assert_array_equal(read_image(tmp_path / "a.png"), np.broadcast_to(expected, rgb.shape))


@pytest.mark.parametrize("mode", ["1", "L", "LA", "P", "PA", "CMYK", "RGBA"])
def test_modes(tmp_path, rgb, mode):
    source = Image.fromarray(rgb)
    if mode == "PA":
        image = source.convert("RGBA").quantize(16)
        image.info["transparency"] = bytes(range(0, 256, 16))
        alpha = np.array(range(0, 256, 16))[np.asarray(image)][..., None]
        colours = np.array(image.getpalette(), int).reshape(-1, 3)[np.asarray(image)]
        expected = (colours * alpha + 255 * (255 - alpha)) / 255
    else:
        image = source.convert(mode)
        if mode in ("LA", "RGBA"):
            image.putalpha(Image.fromarray(rgb[..., 0]))
        grey = np.asarray(image.convert("RGB" if mode in ("1", "P", "CMYK") else image.mode))
        expected = np.broadcast_to(on_white(grey, 255), rgb.shape) if mode in ("LA", "RGBA") else grey
        expected = np.broadcast_to(grey[..., None], rgb.shape) if mode == "L" else expected
    image.save(tmp_path / ("a.tiff" if mode == "CMYK" else "a.png"))
    got = read_image(tmp_path / ("a.tiff" if mode == "CMYK" else "a.png"))
    assert got.shape == (11, 7, 3)
    np.testing.assert_allclose(got.astype(float), expected, atol=0.51)


@pytest.mark.parametrize(("mode", "clear"), [("L", 7), ("RGB", (1, 2, 3)), ("I;16", 700)])
def test_colour_that_means_transparent(tmp_path, mode, clear):
    if mode == "I;16":
        image = Image.fromarray(np.array([[700, 300 * 256 // 2]], np.uint16))
    else:
        image = Image.new(mode, (2, 1), clear)
        image.putpixel((1, 0), 200 if mode == "L" else (200, 200, 200))
    image.save(tmp_path / "a.png", transparency=clear)
    got = read_image(tmp_path / "a.png")
    assert (got[0, 0] == 255).all() and (got[0, 1] < 255).all()


@pytest.mark.parametrize("channels", [None, 3, 4])
@pytest.mark.parametrize("suffix", [".png", ".webp"])
def test_write_and_read(tmp_path, channels, suffix):
    pixels = np.full((6, 5) if channels is None else (6, 5, channels), 255, np.uint8)
    pixels[2:, 1:] = 0
    if channels == 4:
        pixels[..., 3] = 255
    write_image(tmp_path / f"a{suffix}", pixels, quality=100)
    expected = np.repeat(pixels[..., None], 3, axis=-1) if channels is None else pixels[..., :3]
    np.testing.assert_allclose(
        read_image(tmp_path / f"a{suffix}").astype(int), expected, atol=0 if suffix == ".png" else 60
    )
    assert encode_image(pixels, suffix) == encode_image(pixels.copy(), suffix)


@pytest.mark.parametrize(
    ("pixels", "name", "message"),
    [
        (np.zeros((4, 4, 3)), "a.png", "img: expected uint8, got float64"),
        (np.zeros((4, 4, 2), np.uint8), "a.png", r"img: .* got shape \(4, 4, 2\)"),
        (np.zeros((0, 4, 3), np.uint8), "a.png", r"img: .* got shape \(0, 4, 3\)"),
        (np.zeros((4, 4, 4), np.uint8), "a.jpg", "JPEG holds no alpha"),
        (np.zeros((4, 4, 3), np.uint8), "a.xyz", "suffix: expected one of .*, got '.xyz'"),
    ],
)
def test_refused_to_write(tmp_path, pixels, name, message):
    with pytest.raises(ValueError, match=message):
        write_image(tmp_path / name, pixels)
    assert list(tmp_path.iterdir()) == []


def png_of_size(width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b"")


def encoded(kind, pixels):
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, kind)
    return stream.getvalue()


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP"])
@pytest.mark.parametrize("share", [0.05, 0.5, 0.9])
def test_truncated(tmp_path, kind, share):
    content = encoded(kind, np.random.default_rng(4).integers(0, 256, (64, 64, 3), dtype=np.uint8))
    path = tmp_path / "cut"
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(ValueError, match=r"expected a picture .*cut is (damaged|none of these)"):
        read_image(path)


@pytest.mark.filterwarnings("ignore::UserWarning:PIL", "ignore::PIL.Image.DecompressionBombWarning")
def test_flipped_bytes_give_a_picture_or_a_value_error(tmp_path, rgb):
    rng = np.random.default_rng(7)
    for kind in ("PNG", "JPEG", "WEBP", "GIF", "TIFF", "BMP"):
        content = encoded(kind, rgb)
        for _ in range(60):
            broken = bytearray(content)
            for place in rng.integers(0, len(content), 3):
                broken[place] = rng.integers(0, 256)
            (tmp_path / "x").write_bytes(broken)
            try:
                assert read_image(tmp_path / "x").shape[2] == 3
            except ValueError as error:
                assert "expected a picture" in str(error)  # noqa: PT017


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "got the empty file"),
        (b"hello", "none of these"),
        (png_of_size(0, 5), "damaged|zero size|none of these"),
        (png_of_size(5, 0), "damaged|zero size|none of these"),
        (png_of_size(100_000, 100_000), "expected a picture of at most 67 Mpx, but .* has 10000 Mpx"),
        (encoded("TIFF", np.zeros((4, 4), np.float32)), "floating-point"),
        (encoded("TIFF", np.full((4, 4), 70_000, np.int32)), "32 bits"),
    ],
    ids=["empty", "text", "no width", "no height", "bomb", "float", "32 bit"],
)
def test_refused(tmp_path, content, message):
    path = tmp_path / "portrait.png"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=message) as info:
        read_image(path)
    assert "portrait.png" in str(info.value)


@pytest.mark.parametrize("side", [9_000, 10_500, 14_000])  # below what Pillow warns of, and above what it refuses
def test_too_many_pixels_are_counted(tmp_path, side):
    path = tmp_path / "a.png"
    path.write_bytes(png_of_size(side, side))
    with pytest.raises(
        ValueError, match=f"expected a picture of at most 67 Mpx, but .*a.png has {side * side / 1e6:.0f} Mpx"
    ):
        read_image(path)


def test_the_limit_can_be_set(tmp_path, rgb):
    write_image(tmp_path / "a.png", rgb)
    count = rgb.shape[0] * rgb.shape[1]
    np.testing.assert_array_equal(read_image(tmp_path / "a.png", max_pixels=count), rgb)
    with pytest.raises(ValueError, match="expected a picture of at most 0 Mpx"):
        read_image(tmp_path / "a.png", max_pixels=count - 1)


def test_no_such_file(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"face\.png"):
        read_image(tmp_path / "face.png")
    with pytest.raises(OSError, match=str(tmp_path)):
        read_image(tmp_path)


def blocks():
    """A picture of coloured squares that JPEG keeps."""
    squares = np.random.default_rng(4).integers(0, 256, (20, 25, 3), dtype=np.uint8)
    return np.repeat(np.repeat(squares, 8, axis=0), 8, axis=1)


@pytest.mark.parametrize("progressive", [False, True])
def test_a_jpeg_without_its_end_mark_is_read_with_a_warning(tmp_path, progressive):
    stream = io.BytesIO()
    Image.fromarray(blocks()).save(stream, "JPEG", quality=90, progressive=progressive)
    whole, path = stream.getvalue(), tmp_path / "a.jpg"
    path.write_bytes(whole)
    expected = read_image(path)
    for lost in (1, 2):
        path.write_bytes(whole[:-lost])
        with pytest.warns(UserWarning, match=r"path: .*a\.jpg is a JPEG without its end mark; all its pixels"):
            np.testing.assert_array_equal(read_image(path), expected)
    for kept in (len(whole) - 40, len(whole) // 2, len(whole) // 4):
        path.write_bytes(whole[:kept])
        with pytest.raises(ValueError, match=r"path: expected a picture .*a\.jpg is damaged"):
            read_image(path)


def test_what_stands_behind_the_end_mark_of_a_jpeg_is_left_alone(tmp_path):
    stream = io.BytesIO()
    Image.fromarray(blocks()).save(stream, "JPEG", quality=90)
    (tmp_path / "a.jpg").write_bytes(stream.getvalue())
    (tmp_path / "b.jpg").write_bytes(stream.getvalue() + b"made by a telephone")
    np.testing.assert_array_equal(read_image(tmp_path / "a.jpg"), read_image(tmp_path / "b.jpg"))


@pytest.mark.parametrize("wrong", [0, -1, 2.5, True, None, "many"])
def test_max_pixels_that_is_no_count(tmp_path, rgb, wrong):
    Image.fromarray(rgb).save(tmp_path / "a.png")
    with pytest.raises(ValueError, match="max_pixels: expected an integer > 0"):
        read_image(tmp_path / "a.png", max_pixels=wrong)


@pytest.mark.parametrize("mode", ["RGBA", "LA", "P", "L", "1", "I;16"])
def test_strips_of_a_picture_are_the_whole(tmp_path, monkeypatch, mode):
    stored = np.random.default_rng(5).integers(0, 255, (37, 23, 4), dtype=np.uint8)
    image = Image.fromarray(stored)
    image = Image.fromarray(stored[..., 0].astype(np.uint16) * 200) if mode == "I;16" else image.convert(mode)
    image.save(tmp_path / "a.png", **({"transparency": 3} if mode in ("P", "I;16") else {}))
    whole = read_image(tmp_path / "a.png")
    monkeypatch.setattr("toongeo.io.readers.read_image._STRIP", 23 * 5)
    np.testing.assert_array_equal(read_image(tmp_path / "a.png"), whole)


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (b"\0\0\0\x18ftypheic\0\0\0\0mif1heic", "HEIC"),
        (b"\0\0\0\x18ftypmif1\0\0\0\0mif1heic", "HEIC"),
        (b"\0\0\0\x1cftypmif1\0\0\0\0mif1avifmiaf", "AVIF"),
        (b"\0\0\0\x18ftypavif\0\0\0\0mif1miaf", "AVIF"),
        (b"\0\0\0\x0cJXL \r\n\x87\n", "JPEG XL"),
        (b"\0\0\0\x0cjP  \r\n\x87\n", "JPEG 2000"),
        (b"\0\0\0\x18ftypisom\0\0\0\0", "a film"),
        (b"8BPS\0\1", "a PSD"),
        (b'<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg"/>', "an SVG"),
        (b"\n<!DOCTYPE html><title>404</title>", "a web page"),
        (b"version https://git-lfs.github.com/spec/v1\n", "a pointer of Git LFS"),
    ],
)
def test_pictures_that_are_not_read_are_called_by_their_name(tmp_path, content, named):
    (tmp_path / "a.jpg").write_bytes(content + bytes(64))
    with pytest.raises(ValueError, match=rf"a\.jpg is {named}, which is not read: write it again as PNG or JPEG"):
        read_image(tmp_path / "a.jpg")


def test_pixels_of_32_bits_are_refused_even_if_they_are_small(tmp_path):
    """Read as 16 bits they would be black."""
    Image.fromarray(np.full((4, 4), 200, np.int32)).save(tmp_path / "a.tif")
    with pytest.raises(ValueError, match="its pixels have 32 bits"):
        read_image(tmp_path / "a.tif")
