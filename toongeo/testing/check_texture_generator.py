"""Whether something is a `TextureGenerator`."""

from __future__ import annotations

import numpy as np

from toongeo.model import default_model
from toongeo.protocols import TextureGenerator, TextureGeometry
from toongeo.testing.example import require, unchanged

__all__ = ["check_texture_generator"]

_SIZE = 64  # texels


def check_texture_generator(generator: TextureGenerator) -> None:
    """Ask a generator for the texture of a smile.

    Parameters
    ----------
    generator : TextureGenerator

    Raises
    ------
    AssertionError
        If colours are not (S, S, 3) in 0..255 or attention not (S, S) in [0, 1], or the texture is written to.

    Examples
    --------
    >>> check_texture_generator(lambda texture, source, target, geometry: (texture, np.ones(texture.shape[:2])))
    """
    model = default_model()
    source, target = np.zeros(model.n_named), np.zeros(model.n_named)
    target[[model.expression_index(name) for name in ("mouthSmileLeft", "mouthSmileRight")]] = 0.8
    posed = model.mean + np.tensordot(target, model.expression[: model.n_named], 1)
    geometry = TextureGeometry(model.mean, posed, model.faces, model.uv, model.uv_faces)
    texture = np.random.default_rng(0).integers(60, 220, (_SIZE, _SIZE, 3)).astype(np.uint8)
    before = texture.copy()
    colour, attention = generator(texture, source, target, geometry)
    unchanged("texture", before, texture)
    fits = np.shape(colour) == texture.shape and np.shape(attention) == texture.shape[:2]
    require(fits, f"generator: expected {texture.shape} and {texture.shape[:2]}, got {np.shape(colour)} and others")
    require((np.asarray(colour) >= 0).all() and (np.asarray(colour) <= 255).all(), "colour: expected 0..255")
    require((np.asarray(attention) >= 0).all() and (np.asarray(attention) <= 1).all(), "attention: expected [0, 1]")
