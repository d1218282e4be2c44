"""What an expression does to the colours of a face, without a network."""

import cv2
import numpy as np

from toongeo.caricature._atlas_raster import AtlasRaster
from toongeo.caricature._lid_skin import lash_colour, lash_lines, lid_skin, lid_zones
from toongeo.caricature._mouth_palette import mouth_palette
from toongeo.caricature._openings import lid_closing, lips_parted
from toongeo.caricature._picture_mesh import INNER_PARTS
from toongeo.caricature._shading_ratio import ShadingRatio
from toongeo.caricature.attention_map import MAP_SIDE, attention_map
from toongeo.geometry import vertex_normals
from toongeo.model import MorphableModel
from toongeo.pipeline import Rig
from toongeo.protocols import TextureGeometry
from toongeo.render import sample_image, srgb_to_linear, uv_to_px

OUTWARD, INWARD = 0.6, 0.35  # cosine to the front beyond which a lip is its red, and below which it is its inner side
INNER_LIP = 0.8  # of the lightness of the lips


class ClassicalTextureGenerator:
    """The default :class:`~toongeo.protocols.TextureGenerator`: geometry and the drawing's own palette, no network.

    Attention is the displacement of the geometry in texture space (:func:`attention_map`). Colours are the texture
    lit anew (ratios of the shading of new and old normals), lids of closing eyes in the skin around them with a lash
    line, and teeth, tongue and cavity of the template matched to the drawing's palette.

    Parameters
    ----------
    model : MorphableModel
    rig : Rig
        Its blinks tell which skin is a lid's.
    texture : (S, S, 3) uint8 RGB
        Atlas from :func:`toongeo.bake_texture`, from which palette and light are taken.

    Raises
    ------
    ValueError
        If the texture is not square uint8 RGB.
    """

    def __init__(self, model: MorphableModel, rig: Rig, texture: np.ndarray) -> None:
        _check_texture(texture)
        self.model, self.size = model, len(texture)
        V = rig.neutral
        normals = vertex_normals(V, model.faces)
        colours = _vertex_colours(model, texture)
        eyes = model.region("eye_left") | model.region("eye_right")
        brows = model.region("brow_left") | model.region("brow_right")
        skin = model.region("face") & ~model.region("lips") & ~eyes & ~brows & (normals[:, 2] > 0)
        lip = model.region("lips") & (normals[:, 2] > OUTWARD)
        linear = srgb_to_linear((colours / 255).astype(np.float32)).mean(1)
        self._ratio = ShadingRatio(linear, V, model.faces, skin)
        self._zones = lid_zones(model, rig)
        clean = lid_skin(model, colours, self._zones, skin)
        self._inner = np.any([model.region(name) for name in INNER_PARTS], axis=0)
        inner_lip = model.region("lips") & (normals[:, 2] < INWARD) & ~self._inner
        for part in (model.region("lip_upper"), model.region("lip_lower")):
            own = lip & part if (lip & part).any() else lip
            clean[inner_lip & part] = INNER_LIP * np.median(colours[own], axis=0)
        clean = mouth_palette(model, V, clean, lip, skin)
        self._fresh = (self._inner | inner_lip).astype(np.float32)
        raster = AtlasRaster(model.faces, model.uv, model.uv_faces, self.size)
        self._clean = raster.image(clean)
        masks = raster.image(np.column_stack([*self._zones, self._fresh]))
        self._zone_texels, self._fresh_texels = np.moveaxis(masks[..., :2], 2, 0), masks[..., 2:]
        self._lashes = lash_lines(model, V, self.size)
        self._lash_colour = lash_colour(model, colours, skin).astype(np.float32)
        self._coarse = AtlasRaster(model.faces, model.uv, model.uv_faces, min(self.size, MAP_SIDE))

    def __call__(
        self, texture: np.ndarray, source: np.ndarray, target: np.ndarray, geometry: TextureGeometry
    ) -> tuple[np.ndarray, np.ndarray]:
        """Colour C (S, S, 3) float32, 0-255, and attention A (S, S) float32 (Chen et al. 2020, Eq. 12).

        The classical generator looks at the geometry, not at the weights ``source`` and ``target`` that made it.

        Raises
        ------
        ValueError
            If the texture has another size than the one that the generator was made for.
        """
        _check_texture(texture)
        if len(texture) != self.size:
            raise ValueError(f"texture: expected {self.size} x {self.size} texels, got {texture.shape}")
        closing = lid_closing(self.model, geometry.source, geometry.target)
        parted = lips_parted(self.model, geometry.target)
        attention = attention_map(geometry, self.size, extra=self._extra(closing, parted), raster=self._coarse)
        ratio = self._coarse.image(self._ratio(geometry.source, geometry.target)[:, None], empty=1.0)
        ratio = cv2.GaussianBlur(ratio, (0, 0), 1.0)
        ratio = cv2.resize(ratio, (self.size, self.size), interpolation=cv2.INTER_LINEAR)[..., None]
        colour = texture * ratio
        share = np.maximum(np.maximum(closing[0] * self._zone_texels[0], closing[1] * self._zone_texels[1])[..., None], parted * self._fresh_texels)
        colour += share * (self._clean - colour)
        lash = np.maximum(closing[0] * self._lashes[0], closing[1] * self._lashes[1])[..., None]
        colour += lash * (self._lash_colour - colour)
        return np.clip(colour, 0, 255, out=colour), attention

    def renewed(self, geometry: TextureGeometry) -> np.ndarray:
        """How far (n,) in [0, 1] a vertex shows what the source does not: skin of a closing lid, inside of a mouth."""
        closing = lid_closing(self.model, geometry.source, geometry.target)
        return self._extra(closing, lips_parted(self.model, geometry.target))

    def _extra(self, closing: np.ndarray, parted: float) -> np.ndarray:
        lids = np.maximum(closing[0] * self._zones[0], closing[1] * self._zones[1])
        return np.asarray(np.maximum(lids, parted * self._fresh), np.float32)


def _vertex_colours(model: MorphableModel, texture: np.ndarray) -> np.ndarray:
    """Colours (n, 3) float32, 0-255, that a texture has at the vertices."""
    colours = np.zeros((len(model.mean), 3), np.float32)
    at_corners = sample_image(texture, uv_to_px(model.uv, len(texture), len(texture)))
    colours[model.faces] = at_corners[model.uv_faces]
    return colours


def _check_texture(texture: np.ndarray) -> None:
    if texture.dtype != np.uint8 or texture.ndim != 3 or texture.shape[0] != texture.shape[1] or texture.shape[2] != 3:
        raise ValueError(f"texture: expected (S, S, 3) uint8, got {texture.dtype} of shape {texture.shape}")
