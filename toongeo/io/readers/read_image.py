"""A picture file as sRGB pixels."""

import io
import os
import re
import struct
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps

__all__ = ["read_image"]

# Only decoders that need no outside program; Pillow would otherwise try every format it knows on a
# stranger's file.
_FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "GIF", "TIFF")
# What Pillow's decoders raise on damaged files, besides the OSError they should.
_DECODE_ERRORS = (
    OSError,
    SyntaxError,
    ValueError,
    EOFError,
    IndexError,
    KeyError,
    TypeError,
    OverflowError,
    struct.error,
    zlib.error,
)
_MAX_PIXELS = 2**26  # 8192 x 8192, more than cameras give; some 0.5 GB while it is read


def read_image(path: str | os.PathLike[str], *, max_pixels: int = _MAX_PIXELS) -> NDArray[np.uint8]:
    """Read a picture as it is meant to be seen.

    Pillow decodes it (OpenCV either ignores the EXIF rotation or drops the alpha channel).

    Parameters
    ----------
    path
        PNG, JPEG, WebP, BMP, GIF (first frame) or TIFF; colour, grey or palette, 8 or 16 bit, with or
        without alpha.

    Returns
    -------
    (H, W, 3) uint8
        sRGB. The EXIF rotation is applied, alpha is composited on white, 16 bit are reduced to their high
        byte. Colour profiles are ignored.

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
    content = Path(path).read_bytes()
    if not content:
        raise ValueError(f"path: expected a picture, got the empty file {path}")
    try:
        with Image.open(io.BytesIO(content), formats=_FORMATS) as image:
            if image.width * image.height <= max_pixels:
                image.load()
                pixels = _rgb(ImageOps.exif_transpose(image))
            else:
                raise Image.DecompressionBombError(f"{image.width * image.height} pixels")
    except (Image.DecompressionBombError, Image.DecompressionBombWarning) as error:  # Pillow has a limit as well
        found = re.search(r"(\d+) pixels", str(error))
        got = f"{int(found[1]) / 1e6:.0f} Mpx" if found else "more"
        raise ValueError(
            f"path: expected a picture of at most {max_pixels / 1e6:.0f} Mpx, but {path} has {got}"
        ) from None
    except _DECODE_ERRORS as error:
        reason = "none of these" if isinstance(error, Image.UnidentifiedImageError) else f"damaged ({error})"
        raise ValueError(f"path: expected a picture ({', '.join(_FORMATS)}), but {path} is {reason}") from error
    if pixels.size == 0:
        raise ValueError(f"path: expected a picture, but {path} has zero size {pixels.shape[:2]}")
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
