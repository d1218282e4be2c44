"""What paints a primitive of a glTF: the base colour of its material."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image

from toongeo.arrays import Bytes, Floats
from toongeo.colour.srgb import linear_to_srgb
from toongeo.io.readers.read_glb import GlbDocument

__all__ = ["BaseColour", "base_colour"]

_FORMATS = ("PNG", "JPEG", "WEBP")
_MAX_PIXELS = 2**26  # as of a picture that is read


@dataclass(frozen=True, eq=False)
class BaseColour:
    """Colour (sRGB, 0..1), picture if there is one that is embedded, and which texture coordinates it uses, and how."""

    color: tuple[float, float, float]
    picture: Bytes | None
    texcoord: int
    transform: Floats  # (3, 3), of the file's texture coordinates, v down


def base_colour(document: GlbDocument, primitive: dict[str, Any]) -> BaseColour:
    """The base colour of a primitive; white without a material.

    Raises
    ------
    ValueError, LookupError
        If a picture is damaged or too large, or an index leads nowhere.
    """
    material = document.json["materials"][primitive["material"]] if "material" in primitive else {}
    look = material.get("pbrMetallicRoughness", {})
    linear = np.clip(np.array(look.get("baseColorFactor", [1, 1, 1]), np.float64)[:3], 0, 1)
    red, green, blue = (float(value) for value in linear_to_srgb(linear))
    texture = look.get("baseColorTexture")
    if texture is None:
        return BaseColour((red, green, blue), None, 0, np.eye(3))
    moved = texture.get("extensions", {}).get("KHR_texture_transform", {})
    texcoord = moved.get("texCoord", texture.get("texCoord", 0))
    return BaseColour((red, green, blue), _picture(document, texture["index"]), texcoord, _transform(moved))


def _transform(moved: dict[str, Any]) -> Floats:
    """KHR_texture_transform: scaled, turned counter-clockwise as the picture is seen (v down), and moved."""
    turn = float(moved.get("rotation", 0))
    cos, sin = np.cos(turn), np.sin(turn)
    matrix = np.eye(3)
    matrix[:2, :2] = np.array([[cos, sin], [-sin, cos]]) * np.array(moved.get("scale", [1, 1]), np.float64)
    matrix[:2, 2] = moved.get("offset", [0, 0])
    return matrix


def _picture(document: GlbDocument, index: int) -> Bytes | None:
    texture = document.json["textures"][index]
    source = texture.get("extensions", {}).get("EXT_texture_webp", texture).get("source")
    if source is None:
        return None
    uri = document.json["images"][source].get("uri", "")
    # A file may not name others to be opened.
    content = base64.b64decode(uri.partition(",")[2]) if uri.startswith("data:") else document.images[source]
    if not content:
        return None
    with Image.open(io.BytesIO(content), formats=_FORMATS) as picture:
        if picture.width * picture.height > _MAX_PIXELS:
            raise ValueError(f"its picture {source} has {picture.width * picture.height / 1e6:.0f} Mpx")
        return np.array(picture.convert("RGB"))
