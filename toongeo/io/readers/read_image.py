"""A picture file as sRGB pixels."""

import hashlib
import io
import os
import re
import warnings

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps

from toongeo.reading.check_file import file_bytes
from toongeo.reading.promise import promised

__all__ = ["read_image"]

# Only decoders that need no outside program; Pillow would otherwise try every format it knows on a
# stranger's file.
_FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "GIF", "TIFF")
# How what people take for pictures begins, that is to be called by its name.
_OTHERS = (
    ("AVIF", b".{4}ftyp.{0,24}avi[fs]"),
    ("HEIC", b".{4}ftyp(hei[cmsx]|hev[cmsx]|mif1|msf1)"),
    ("JPEG XL", rb"\xff\x0a|.{4}JXL "),
    ("JPEG 2000", rb".{4}jP  |\xff\x4f\xff\x51"),
    ("a film", rb".{4}ftyp|\x1aE\xdf\xa3|RIFF.{4}AVI "),
    ("a PSD", b"8BPS"),
    ("an SVG", rb"\s*(<\?xml.{0,500})?(<!--.{0,500}-->\s*)?<svg"),
    ("a PDF", b"%PDF"),
    ("a web page", rb"(?i)\s*<(!doctype html|html)"),
    ("a pointer of Git LFS", b"version https://git-lfs"),
    ("an EXR", rb"\x76\x2f\x31\x01"),
)
_BITS = 258  # TIFF's tag BitsPerSample
_EXPECTED = f"a picture ({', '.join(_FORMATS)})"
_MAX_PIXELS = 2**26  # 8192 x 8192, more than most cameras give; some 0.7 GB while it is read
_STRIP = 2**20  # pixels that are composited at once, so that a few MB do, whatever the picture has
_END, _SCAN = b"\xff\xd9", b"\xff\xda"  # of a JPEG; what it has after its last scan is its end mark
# What a decoder finds behind a whole scan changes nothing; where blocks are missing they come out otherwise.
_TAILS = (b"", 64 * b"\x55", 64 * b"\xaa\x2b")


@promised(_EXPECTED)
def read_image(path: str | os.PathLike[str], *, max_pixels: int = _MAX_PIXELS) -> NDArray[np.uint8]:
    """Read a picture as it is meant to be seen.

    Pillow decodes it (OpenCV either ignores the EXIF rotation or drops the alpha channel).

    Parameters
    ----------
    path
        PNG, JPEG, WebP, BMP, GIF (first frame) or TIFF; colour, grey or palette, 8 or 16 bit, with or
        without alpha.
    max_pixels
        Larger pictures are refused before they are decoded: a file of some kB may announce gigabytes.

    Returns
    -------
    (H, W, 3) uint8
        sRGB. The EXIF rotation is applied, alpha is composited on white, 16 bit are reduced to their high
        byte. Colour profiles are ignored.

    Warns
    -----
    UserWarning
        If a JPEG lacks its end mark but has all its pixels, as after a transfer that was cut off.

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If it is empty, truncated, damaged, too large, or no picture of these formats.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from toongeo.io import write_image
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "grey.png"
    >>> write_image(path, np.full((2, 3), 128, np.uint8))
    >>> read_image(path).shape
    (2, 3, 3)
    """
    if isinstance(max_pixels, bool) or not isinstance(max_pixels, int | np.integer) or max_pixels < 1:
        raise ValueError(f"max_pixels: expected an integer > 0, got {max_pixels!r}")
    content = file_bytes(path)
    if not content:
        raise ValueError(f"path: expected a picture, got the empty file {path}")
    try:
        with Image.open(io.BytesIO(content), formats=_FORMATS) as image:
            if image.width * image.height > max_pixels:
                raise Image.DecompressionBombError(f"{image.width * image.height} pixels")
            unended = image.format == "JPEG" and content.rfind(_END) < content.rfind(_SCAN)
            pixels = _pixels(image) if not unended else _of_unended(content, path)
    except (Image.DecompressionBombError, Image.DecompressionBombWarning) as error:  # Pillow has a limit as well
        found = re.search(r"(\d+) pixels", str(error))
        got = f"{int(found[1]) / 1e6:.0f} Mpx" if found else "more"
        raise ValueError(
            f"path: expected a picture of at most {max_pixels / 1e6:.0f} Mpx, but {path} has {got}"
        ) from None
    except Image.UnidentifiedImageError as error:
        kind = next((name for name, start in _OTHERS if re.match(start, content, re.DOTALL)), None)
        got = (
            "none of these, or damaged" if kind is None else f"{kind}, which is not read: write it again as PNG or JPEG"
        )
        raise ValueError(f"path: expected {_EXPECTED}, but {path} is {got}") from error
    if pixels.size == 0:
        raise ValueError(f"path: expected a picture, but {path} has zero size {pixels.shape[:2]}")
    return pixels


def _of_unended(content: bytes, path: object) -> NDArray[np.uint8]:
    """Pixels of a JPEG without an end mark, if nothing else is missing."""
    content = content.rstrip(b"\xff")  # half of the mark
    decoded = set()
    for tail in _TAILS:
        with Image.open(io.BytesIO(content + tail + _END), formats=("JPEG",)) as image:
            decoded.add(hashlib.sha256(image.tobytes()).digest())
    if len(decoded) > 1:
        raise ValueError(f"path: expected {_EXPECTED}, but {path} is damaged (a JPEG that is cut off)")
    warnings.warn(f"path: {path} is a JPEG without its end mark; all its pixels are there", stacklevel=4)
    with Image.open(io.BytesIO(content + _END), formats=("JPEG",)) as image:
        return _pixels(image)


def _pixels(image: Image.Image) -> NDArray[np.uint8]:
    """(H, W, 3) of an opened picture as it is meant to be seen, composited strip by strip."""
    if image.mode == "I" and 32 in getattr(image, "tag_v2", {}).get(_BITS, ()):
        raise ValueError("its pixels have 32 bits; 8 or 16 bit expected")
    image.load()
    image = ImageOps.exif_transpose(image)
    pixels = np.empty((image.height, image.width, 3), np.uint8)
    rows = max(1, _STRIP // max(1, image.width))
    for top in range(0, image.height, rows):
        bottom = min(top + rows, image.height)
        pixels[top:bottom] = _rgb(image.crop((0, top, image.width, bottom)))
    return pixels


def _rgb(image: Image.Image) -> NDArray[np.uint8]:
    """(H, W, 3) of an image in any of Pillow's modes, on white."""
    if image.mode == "F":
        raise ValueError("its pixels are floating-point numbers; 8 or 16 bit expected")
    if image.mode.startswith("I"):  # 16-bit grey; Pillow's own conversion would clip it at 255
        grey = np.asarray(image).astype(np.int64)
        if grey.min() < 0 or grey.max() > 65535:
            raise ValueError("its pixels have 32 bits; 8 or 16 bit expected")
        clear = image.info.get("transparency")
        grey = np.where(grey == clear, 65535, grey) if isinstance(clear, int) else grey
        return np.repeat((grey >> 8).astype(np.uint8)[..., None], 3, axis=-1)
    if not image.has_transparency_data:
        return np.array(image.convert("RGB"))
    rgba = np.asarray(image.convert("RGBA")).astype(np.uint16)
    colour, alpha = rgba[..., :3], rgba[..., 3:]
    # At most 255 * 255 + 127, so 16 bits hold it; + 127 rounds.
    return ((colour * alpha + np.uint16(255) * (255 - alpha) + 127) // 255).astype(np.uint8)
