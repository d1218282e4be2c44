"""What an expression does to the colours of a face, without a network.

Constants were judged on the seven examples (``benchmarks/editing.py``).
"""

import cv2
import numpy as np

from toongeo.editing.attention_map import MAP_SIDE, attention_map
from toongeo.editing.texture.atlas_raster import AtlasRaster
from toongeo.editing.texture.lid_skin import lash_lines
from toongeo.editing.texture.match_colours import to_lab
from toongeo.editing.texture.mouth_palette import mouth_palette
from toongeo.editing.texture.new_skin import NewSkin
from toongeo.editing.texture.openings import lid_closing, lips_parted
from toongeo.editing.texture.shading_ratio import ShadingRatio
from toongeo.editing.texture.spread_field import spread_field
from toongeo.geometry import vertex_normals
from toongeo.model import MorphableModel
from toongeo.pipeline import Rig
from toongeo.pipeline.texture.closed_lids import closed_lids
from toongeo.protocols import TextureGeometry
from toongeo.render import srgb_to_linear

__all__ = ["ClassicalTextureGenerator"]

_OUTWARD = 0.6  # cosine to the front beyond which a lip is its red
_PLAIN = 60.0  # of 255: a colour that differs more from the skin's is a line's and says nothing about the light
_FLAT, _SHADED = 1.0, 6.0  # L: spread of the lightness of plain skin without and with full shading
_MOST_RELIEF = 0.6  # of that of an avatar's lids, which are seen in the light of a viewer
_GRAIN, _MOST_GRAIN = 0.006, 24.0  # s.d. of the atlas's side; of 255
_INNER_LIP = 0.8  # of the lightness of the lips


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

    Examples
    --------
    >>> import toongeo as tg
    >>> from toongeo.model import data_path
    >>> img = tg.read_image(data_path("examples/portraits/moustache_man.png"))
    >>> landmarks = tg.read_landmarks(data_path("examples/portraits/moustache_man.pts"))
    >>> avatar = tg.make_avatar(img, landmarks, hair=False)
    >>> generator = tg.ClassicalTextureGenerator(avatar.fit.model, avatar.rig, avatar.texture)
    >>> model, wanted = avatar.fit.model, {"jawOpen": 1.0}
    >>> surfaces = avatar.vertices(), avatar.vertices(wanted)
    >>> geometry = tg.TextureGeometry(*surfaces, model.faces, model.uv, model.uv_faces)
    >>> colour, attention = generator(avatar.texture, avatar.rig.weights(), avatar.rig.weights(wanted), geometry)
    >>> colour.shape, attention.shape  # T* = A T + (1 - A) C: see tg.compose_texture
    ((1024, 1024, 3), (1024, 1024))
    """

    def __init__(self, model: MorphableModel, rig: Rig, texture: np.ndarray) -> None:
        _check_texture(texture)
        self.model, self.size = model, len(texture)
        V = rig.neutral
        new = self._new = NewSkin(model, rig, texture)
        lip = model.region("lips") & (vertex_normals(V, model.faces)[:, 2] > _OUTWARD)
        linear = srgb_to_linear((new.colours / 255).astype(np.float32)).mean(1)
        plain = new.skin & (np.abs(new.colours - np.median(new.colours[new.skin], axis=0)).max(1) < _PLAIN)
        self._ratio = ShadingRatio(linear, V, model.faces, plain)
        clean = closed_lids(model, rig, new.zones, new.colours, _relief(new.colours[plain])).astype(np.float32)
        for part in (model.region("lip_upper"), model.region("lip_lower")):
            own = lip & part if (lip & part).any() else lip
            clean[new.inner_lip & part] = _INNER_LIP * np.median(new.colours[own], axis=0)
        clean = mouth_palette(model, V, clean, lip, new.skin)
        raster = AtlasRaster(model.faces, model.uv, model.uv_faces, self.size)
        covered = np.zeros(self.size**2, bool)
        covered[raster.texels] = True
        self._clean = spread_field(raster.image(clean), covered.reshape(self.size, self.size))
        # Cavity and inner lips, which are hardly ever drawn; then teeth and tongue, which the atlas may have as drawn.
        seldom = new.inner & ~model.region("mouth_cavity")
        masks = raster.image(np.column_stack([*new.zones, new.fresh * ~seldom, new.fresh * seldom]))
        masks = np.moveaxis(spread_field(masks, covered.reshape(self.size, self.size)), 2, 0)
        _add_grain(self._clean, texture, masks[:2])
        self._fresh_texels = [_boxed(mask) for mask in masks]
        self._lashes = [_boxed(line) for line in lash_lines(model, V, self.size)]
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
        opened = parted * (1 - lips_parted(self.model, geometry.source))
        attention = attention_map(geometry, self.size, extra=self._new.shown(closing, parted), raster=self._coarse)
        ratio = self._coarse.image(self._ratio(geometry.source, geometry.target)[:, None], empty=1.0)
        ratio = cv2.resize(cv2.GaussianBlur(ratio, (0, 0), 1.0), (self.size, self.size), interpolation=cv2.INTER_LINEAR)
        ratio = cv2.merge([ratio, ratio, ratio])
        colour = texture * ratio
        for strength, (box, share) in zip((*closing, parted, opened), self._fresh_texels, strict=True):
            # Folded lids have normals that say little, so what is new is lit as it was matched.
            colour[box] += strength * share * (self._clean[box] - colour[box])
        for strength, (box, cover) in zip(closing, self._lashes, strict=True):
            colour[box] += strength * cover * (self._new.lash_colour - colour[box])
        return np.clip(colour, 0, 255, out=colour), attention


def _relief(skin: np.ndarray) -> float:
    """How much a drawing is shaded, from 0 for flat colour to its most, by the lightness of plain skin (k, 3)."""
    lightness = to_lab(skin)[:, 0]
    spread = np.subtract(*np.percentile(lightness, [75, 25])) / 1.35
    return float(_MOST_RELIEF * np.clip((spread - _FLAT) / (_SHADED - _FLAT), 0, 1))


def _add_grain(clean: np.ndarray, texture: np.ndarray, zones: np.ndarray) -> None:
    """Give smooth lids, in place, the fine texture of the skin below the eye."""
    pixels = texture.astype(np.float32)
    detail = pixels - cv2.GaussianBlur(pixels, (0, 0), _GRAIN * len(texture))
    detail[np.abs(detail).max(2) > _MOST_GRAIN] = 0  # lines are no grain
    for zone in zones:
        box, share = _boxed(zone)
        height = share.shape[0]
        below = slice(box[0].start + 2 * height, box[0].stop + 2 * height)
        if height and below.stop <= len(texture):
            clean[box] += share * detail[below, box[1]]


def _boxed(mask: np.ndarray) -> tuple[tuple[slice, slice], np.ndarray]:
    """Rows and columns in which a mask (S, S) is not 0, and the mask there (h, w, 1)."""
    rows, columns = np.flatnonzero(mask.any(1)), np.flatnonzero(mask.any(0))
    if not len(rows):
        return np.s_[:0, :0], np.zeros((0, 0, 1), np.float32)
    box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    return box, np.ascontiguousarray(mask[box][..., None], np.float32)


def _check_texture(texture: np.ndarray) -> None:
    if texture.dtype != np.uint8 or texture.ndim != 3 or texture.shape[0] != texture.shape[1] or texture.shape[2] != 3:
        raise ValueError(f"texture: expected (S, S, 3) uint8, got {texture.dtype} of shape {texture.shape}")
